"""Systems of grains: slow twins of contact, clumps, segments and the pair list; states compared as a whole."""
