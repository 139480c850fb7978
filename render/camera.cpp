#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace icloth {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSteepest = 0.495 * kPi;           // straight down would leave `right` undefined
constexpr double kShortest = 1e-3, kLongest = 1e4;  // distance to the target [m]

}  // namespace

Camera::Camera(const CameraPose& pose)
    : target_(pose.target), fov_(std::clamp(pose.fov, 1., 150.)) {
  // The eye relative to the target tells yaw, pitch and distance; an eye on the target keeps the
  // defaults.
  const Vec3d offset = pose.eye - pose.target;
  const double length = norm(offset);
  distance_ = std::clamp(length, kShortest, kLongest);
  if (length == 0) return;
  yaw_ = std::atan2(offset.x, offset.z);
  pitch_ = std::clamp(std::asin(std::clamp(offset.y / length, -1., 1.)), -kSteepest, kSteepest);
}

CameraPose Camera::pose() const {
  CameraPose pose;
  pose.eye = eye();
  pose.target = target_;
  pose.up = {0, 1, 0};
  pose.fov = fov_;
  return pose;
}

Vec3d Camera::forward() const {
  return -Vec3d{std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_),
                std::cos(yaw_) * std::cos(pitch_)};
}

Vec3d Camera::right() const { return {std::cos(yaw_), 0, -std::sin(yaw_)}; }

Vec3d Camera::up() const { return cross(right(), forward()); }

Vec3d Camera::eye() const { return target_ - distance_ * forward(); }

double Camera::half_height() const { return std::tan(fov_ * kPi / 360); }

void Camera::orbit(double dx, double dy, int height, double floor) {
  const double turn = kPi / std::max(1, height);
  yaw_ = std::remainder(yaw_ - turn * dx, 2 * kPi);

  // A target below the floor is looked at from straight above at most.
  const double sine = (floor - target_.y) / distance_;
  const double lowest = std::clamp(std::asin(std::clamp(sine, -1., 1.)), -kSteepest, kSteepest);
  pitch_ = std::clamp(pitch_ + turn * dy, lowest, kSteepest);
}

void Camera::look_along(Vec3d direction) {
  CameraPose turned = pose();
  turned.eye = target_ - distance_ * normalized(direction);
  *this = Camera(turned);
}

void Camera::lift_above(double floor) { target_.y += std::max(0., floor - eye().y); }

void Camera::pan(double dx, double dy, int height) {
  const double pixel = pixel_size(distance_, height);
  target_ += (-dx * pixel) * right() + (dy * pixel) * up();
}

void Camera::dolly(double factor) {
  distance_ = std::clamp(distance_ * factor, kShortest, kLongest);
}

void Camera::dolly_to(double factor, Vec3d point) {
  const double before = distance_;
  dolly(factor);
  target_ = point + (distance_ / before) * (target_ - point);
}

void Camera::set_pivot(Vec3d point) {
  CameraPose turned = pose();
  turned.target = point;
  if (norm(turned.eye - point) > kShortest) *this = Camera(turned);
}

void Camera::frame_box(Vec3d low, Vec3d high, double aspect) {
  // The distance is the farthest back that any corner of the box needs the eye to be, for the
  // picture's height and width.
  const double vertical = half_height() * 0.92, horizontal = vertical * aspect;
  target_ = 0.5 * (low + high);
  double needed = kShortest;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p = Vec3d{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                          corner & 4 ? high.z : low.z} -
                    target_;
    const double ahead = dot(p, forward());
    needed = std::max({needed, std::fabs(dot(p, right())) / horizontal - ahead,
                       std::fabs(dot(p, up())) / vertical - ahead});
  }
  distance_ = std::clamp(needed, kShortest, kLongest);
}

Ray Camera::ray(double x, double y, int width, int height) const {
  const double scale = 2 * half_height() / height;
  const double across = (x - 0.5 * width) * scale, above = (0.5 * height - y) * scale;
  return {eye(), normalized(forward() + across * right() + above * up())};
}

Projected Camera::project(Vec3d point, int width, int height) const {
  const Vec3d p = point - eye();
  const double depth = dot(p, forward());
  const double scale = 1 / pixel_size(depth, height);
  return {0.5 * width + scale * dot(p, right()), 0.5 * height - scale * dot(p, up()), depth};
}

double Camera::pixel_size(double depth, int height) const {
  return 2 * depth * half_height() / std::max(1, height);
}

}  // namespace icloth
