"""Pictures and films of a run.  No physics."""
