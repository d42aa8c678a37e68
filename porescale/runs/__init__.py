"""A model driven through time and the record of it: files, checkpoints, pictures.  No physics."""
