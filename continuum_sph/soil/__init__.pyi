# The public names of continuum_sph.soil: soil, its law and its motion.
from .flow import SoilFlow as SoilFlow
from .material import Material as Material
from .material import Rate as Rate
from .material import Softening as Softening
from .material import porosity as porosity
from .material import table as table
from .parameters import SoilLaw as SoilLaw
from .state import Soil as Soil
from .stress import XX as XX
from .stress import YY as YY
