"""Contact laws, one file each.  A law knows its restitution, contact time and stable step."""
