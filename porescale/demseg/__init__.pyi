# The public names of porescale.demseg: decks read, run, recorded and drawn.
from .build import Options as Options
from .deck import MOVED as MOVED
from .deck import NEW as NEW
from .deck import Body as Body
from .deck import Control as Control
from .deck import Deck as Deck
from .deck import read_deck as read_deck
from .run import DeckRun as DeckRun
from .tension import tensions as tensions
from .trace import Trace as Trace
from .trace import draw_energies as draw_energies
from .trace import draw_fall as draw_fall
from .trace import draw_shapes as draw_shapes
from .trace import fallen as fallen
from .trace import trace as trace
from .trace import unbalanced as unbalanced
