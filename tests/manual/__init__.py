"""The manual: built, its links checked, the code of its pages run."""
