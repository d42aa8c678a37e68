# The public names of porescale.output: what the scripts of cases share: options, rows against expected.toml, figures.
from .case import conclude as conclude
from .case import draw as draw
from .case import options as options
from .case import stage as stage
from .case_bodies import LARGEST as LARGEST
from .case_bodies import PLATE as PLATE
from .case_bodies import Shot as Shot
from .case_bodies import by_piece as by_piece
from .case_bodies import draw_bodies as draw_bodies
from .case_bodies import draw_cracks as draw_cracks
from .case_bodies import frame as frame
from .case_bodies import keep as keep
from .case_bodies import pixels as pixels
from .case_bodies import shot as shot
from .case_trade import Tried as Tried
from .case_trade import trade as trade
