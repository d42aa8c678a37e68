"""One file per command.  Each has ``command(package)``, which gives the function that the command line calls."""
