"""The page of a run: its frames, tables and texts as a browser reads them, in one file or from a server."""
