"""Contact laws, one file each.  A law gives its restitution, contact time and stable step."""
