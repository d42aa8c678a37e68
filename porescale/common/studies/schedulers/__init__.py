"""What runs the points of sweeps and studies: processes of this machine, workers of dask, jobs of Slurm."""
