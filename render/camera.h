// A camera that orbits a target; Y is up. Its matrices are in render/view_matrices.h.
#pragma once

#include "sim/scene/scene.h"

namespace icloth {

/// A half-line from a point in a direction.
struct Ray {
  Vec3d origin;     ///< [m]
  Vec3d direction;  ///< unit length
};

/// A point on the picture: x to the right, y down, both in pixels from the top left corner.
struct Projected {
  double x = 0, y = 0;
  double depth = 0;  ///< along the viewing direction [m]; ≤ 0 behind the eye
};

/// The camera of the window and of pictures.
class Camera {
 public:
  Camera() : Camera(CameraPose{}) {}
  /// Takes eye, target and field of view; the horizon stays level whatever `up` is.
  explicit Camera(const CameraPose& pose);

  /// The pose as a scene file stores it.
  CameraPose pose() const;

  Vec3d eye() const;
  Vec3d target() const { return target_; }
  Vec3d forward() const;
  Vec3d right() const;
  Vec3d up() const;
  double distance() const { return distance_; }
  double fov() const { return fov_; }  ///< vertical [degrees]
  /// Half the height of the picture at depth 1: the tangent of half the field of view.
  double half_height() const;

  /// Turns around the target, for a drag of the pointer in pixels on a picture of `height` pixels.
  /// A drag over the whole height is half a turn. It ends where the eye would go below `floor` [m].
  void orbit(double dx, double dy, int height, double floor);
  /// Looks at the target along a direction, from the same distance.
  void look_along(Vec3d direction);
  /// Lifts eye and target by as much as the eye is below `floor` [m].
  void lift_above(double floor);
  /// Moves eye and target so that the target's plane follows the pointer.
  void pan(double dx, double dy, int height);
  /// Multiplies the distance to the target by `factor`.
  void dolly(double factor);
  /// Does the same towards a point that stays where it is on the picture.
  void dolly_to(double factor, Vec3d point);
  /// Turns around another point from now on. The eye stays where it is, and the view direction
  /// turns towards the point.
  void set_pivot(Vec3d point);
  /// Shows a whole box from the present direction.
  void frame_box(Vec3d low, Vec3d high, double aspect);

  /// The ray through a point of the picture; (0.5, 0.5) is the centre of the top left pixel.
  Ray ray(double x, double y, int width, int height) const;
  Projected project(Vec3d point, int width, int height) const;
  /// Size of one pixel at a depth along the viewing direction [m].
  double pixel_size(double depth, int height) const;

 private:
  Vec3d target_;
  double yaw_ = 0, pitch_ = 0;  ///< of the eye seen from the target [rad]
  double distance_ = 1;         ///< [m]
  double fov_ = 35;
};

}  // namespace icloth
