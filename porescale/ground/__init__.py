"""What every floor stands on: compiled-kernel flags, faults, units, constants. No physics."""
