"""What `check` reports of each kind of scene."""
