// Small vectors and 3×3 matrices, the same text for host, device, float and double.
#pragma once

#include <cmath>

#include "kernels/parallel/platform.h"

namespace icloth {

template <class T>
struct Vec2 {
  T x{}, y{};
};

template <class T>
ICLOTH_HD constexpr Vec2<T> operator+(Vec2<T> a, Vec2<T> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
ICLOTH_HD constexpr Vec2<T> operator-(Vec2<T> a, Vec2<T> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
ICLOTH_HD constexpr Vec2<T> operator*(T s, Vec2<T> a) {
  return {s * a.x, s * a.y};
}

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  ICLOTH_HD constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  ICLOTH_HD constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
  ICLOTH_HD friend constexpr Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  ICLOTH_HD friend constexpr Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  ICLOTH_HD friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  ICLOTH_HD friend constexpr Vec3 operator*(T s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  ICLOTH_HD friend constexpr bool operator==(Vec3 a, Vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
ICLOTH_HD constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
ICLOTH_HD constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
ICLOTH_HD constexpr T norm2(Vec3<T> a) {
  return dot(a, a);
}
template <class T>
ICLOTH_HD T norm(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
/// Unit vector along a; the zero vector stays zero.
template <class T>
ICLOTH_HD Vec3<T> normalized(Vec3<T> a) {
  const T length = norm(a);
  return length > T(0) ? (T(1) / length) * a : Vec3<T>{};
}
/// Largest absolute component.
template <class T>
ICLOTH_HD T norm_max(Vec3<T> a) {
  const T x = std::fabs(a.x), y = std::fabs(a.y), z = std::fabs(a.z);
  const T xy = x > y ? x : y;
  return xy > z ? xy : z;
}
/// Converts between precisions, spelled out where it happens.
template <class To, class From>
ICLOTH_HD constexpr Vec3<To> convert(Vec3<From> a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

/// The dot product, multiplied and added in double precision.
template <class T>
ICLOTH_HD constexpr double dot_double(Vec3<T> a, Vec3<T> b) {
  return dot(convert<double>(a), convert<double>(b));
}

/// A 3×3 matrix, row-major.
template <class T>
struct Mat3 {
  T m[9]{};

  ICLOTH_HD constexpr T& operator()(int r, int c) { return m[3 * r + c]; }
  ICLOTH_HD constexpr T operator()(int r, int c) const { return m[3 * r + c]; }
  ICLOTH_HD constexpr Mat3& operator+=(const Mat3& b) {
    for (int k = 0; k < 9; ++k) m[k] += b.m[k];
    return *this;
  }
  ICLOTH_HD static constexpr Mat3 identity(T s = T(1)) {
    Mat3 a;
    a.m[0] = a.m[4] = a.m[8] = s;
    return a;
  }
};

template <class T>
ICLOTH_HD constexpr Vec3<T> operator*(const Mat3<T>& a, Vec3<T> v) {
  return {a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[3] * v.x + a.m[4] * v.y + a.m[5] * v.z,
          a.m[6] * v.x + a.m[7] * v.y + a.m[8] * v.z};
}
template <class T>
ICLOTH_HD constexpr Mat3<T> operator*(T s, Mat3<T> a) {
  for (T& e : a.m) e *= s;
  return a;
}
template <class T>
ICLOTH_HD constexpr Mat3<T> operator+(Mat3<T> a, const Mat3<T>& b) {
  return a += b;
}
template <class T>
ICLOTH_HD constexpr Mat3<T> operator-(const Mat3<T>& a, const Mat3<T>& b) {
  return a + T(-1) * b;
}
template <class T>
ICLOTH_HD constexpr Mat3<T> transpose(const Mat3<T>& a) {
  return {{a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]}};
}
/// The outer product a bᵀ.
template <class T>
ICLOTH_HD constexpr Mat3<T> outer(Vec3<T> a, Vec3<T> b) {
  return {{a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y,
           a.z * b.z}};
}
/// The inverse of a symmetric positive definite matrix, by cofactors.
template <class T>
ICLOTH_HD constexpr Mat3<T> inverse_spd(const Mat3<T>& a) {
  const T c00 = a.m[4] * a.m[8] - a.m[5] * a.m[7];
  const T c01 = a.m[5] * a.m[6] - a.m[3] * a.m[8];
  const T c02 = a.m[3] * a.m[7] - a.m[4] * a.m[6];
  const T d = T(1) / (a.m[0] * c00 + a.m[1] * c01 + a.m[2] * c02);
  const T c11 = a.m[0] * a.m[8] - a.m[2] * a.m[6];
  const T c12 = a.m[1] * a.m[6] - a.m[0] * a.m[7];
  const T c22 = a.m[0] * a.m[4] - a.m[1] * a.m[3];
  return {{d * c00, d * c01, d * c02, d * c01, d * c11, d * c12, d * c02, d * c12, d * c22}};
}

}  // namespace icloth
