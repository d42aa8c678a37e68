"""The run of continuum_sph under a name of its own package: public names are imported from within."""

from porescale.common.api.open_run import Run as Run
