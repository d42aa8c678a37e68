"""What all commands share: scenes, reports, validations, benchmarks, the command line.  No physics."""
