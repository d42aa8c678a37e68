"""What laboratory people measure on grains, one quantity a file.  Rectangular regions; SI per metre of depth.

Compression is positive, as in soil mechanics.  Nothing here changes the state.
"""
