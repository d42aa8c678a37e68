"""Speed-ups: discs at rest and laws without friction cost less.  Each can be deleted without a change of bits."""
