"""Pictures: synthetic pairs, the virtual camera, films, masks."""
