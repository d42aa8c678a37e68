"""A run on disk: a model driven through time, its checkpoints, series, snapshots and card.  No physics."""
