# The public names of porescale.piv.images: the virtual camera, synthetic pairs and their flows.
from . import flows as flows
from .camera import Frame as Frame
from .camera import Shooting as Shooting
from .camera import frames as frames
from .camera import shooting as shooting
from .synth import Camera as Camera
from .synth import Pair as Pair
from .synth import pair as pair
