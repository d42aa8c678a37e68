"""The commands of porescale, one a file; what both packages share is in common.cli."""
