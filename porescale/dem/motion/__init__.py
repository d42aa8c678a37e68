"""Time integration: leap-frog, rigid bodies, prescribed motion, servo walls, strained periodic cells."""
