# The public names of porescale.validation.dem: its topics.
from . import bodies as bodies
from . import critical_step as critical_step
from . import energy as energy
from . import hertz as hertz
from . import measures as measures
from . import momentum as momentum
from . import restitution as restitution
from . import rock as rock
from . import rolling as rolling
from . import segments as segments
from . import setups as setups
from . import sleep as sleep
from . import stacks as stacks
from . import threads as threads
from . import waves as waves
