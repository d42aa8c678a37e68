"""What a scene must not imply, found before anything is built."""
