// What walls in explicit dynamics are measured by: one function for each question.
#pragma once
#include "verification/implicit_boundary/explicit_scenes.h"

namespace wisp::explicit_walls {

/// A block slides down 30 degrees; gravity comes over 0.3 s. Acceleration by a straight line through the
/// velocity from 0.4 s on, over the closed form g (sin - friction cos).
struct Slide {
  double acceleration = 0.0;  ///< over the closed form
  double imbalance = 0.0;     ///< largest |momentum - impulses of wall and gravity| over the last momentum
};
Slide slide(const Variant& variant, double friction);

/// A block on 30 degrees, friction 0.7, brought to rest by ramp and damping over 2 s (8 s with splines, whose
/// creep falls with that time: it is what is left of the damping), then left alone for 2 s.
struct Stick {
  double creep = 0.0;    ///< cells a second, in the first second alone
  double lasting = 0.0;  ///< cells, over both
};
Stick stick(const Variant& variant);

/// A block on an inclined wall, gravity along the wall's normal, brought to rest, then left alone for 1 s;
/// and another on which gravity falls at once.
struct Rest {
  double drift = 0.0;   ///< cells, of the mean height while alone
  double lowest = 0.0;  ///< cells, change of the distance of the lowest point while alone
  double jump = 0.0;    ///< cells, greatest rise above the start under sudden gravity
  double force = 0.0;   ///< mean of the wall's force while alone over the weight
};
Rest rest(const Variant& variant);

/// Speed of the centre after an impact at 1 m/s, block of `cells` cells: largest. A negative angle means a
/// block against its mirror image on a grid line, the body-fitted wall.
double rebound(const Variant& variant, double degrees, int cells);

/// A wall pushes a block with constant acceleration: mean force from 0.2 s to 0.8 s over mass times
/// acceleration, the block's vibrations taken out by a straight line through its momentum.
double push(const Variant& variant);

/// A block at rest in the corner of two walls turned by 20 degrees: forces over the closed forms.
struct Corner {
  double floor = 0.0, side = 0.0;
};
Corner corner(const Variant& variant);

/// A disc of 10 cells' radius rolls (or slides) down 60 degrees from rest; gravity comes over 0.2 s.
struct Roll {
  double way = 0.0;   ///< over the closed form, after 0.8 s
  double spin = 0.0;  ///< likewise
};
Roll roll(const Variant& variant, double friction);

/// Largest stable Courant number by bisection, 300 steps, of a block that vibrates in free flight or pressed
/// against an inclined wall with friction.
double critical_number(const Variant& variant, bool with_wall);

}  // namespace wisp::explicit_walls
