"""What fluid and grains do to each other: partially saturated cells and the loads they give.  Owns no other physics."""
