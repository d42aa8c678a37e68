"""What is the same in the Python interfaces of both packages: scenes, simulations, runs and studies as objects."""
