"""How long runs take: seconds of a quiet machine, and what is expected of a run before it begins."""
