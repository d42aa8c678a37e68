# The public names of porescale.common.pictures: films.
from .film import write_film as write_film
