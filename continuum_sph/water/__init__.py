"""Water and air as layers of smoothed particles."""
