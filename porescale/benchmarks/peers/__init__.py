"""Programs of others that do the same work, measured in turns with ours: `bench --against`."""
