"""The commands of porescale, one a file; what they share with continuum_sph is in the workbench."""
