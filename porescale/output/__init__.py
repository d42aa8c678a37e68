"""Pictures and tables of finished runs beyond those common to both packages."""
