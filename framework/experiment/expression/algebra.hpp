#pragma once

#include <cmath>

// The algebra of 3-vectors over any scalar. Entries that are literally 0 or 1 stay so with a scalar that
// folds constants; hence plain sums of products, and no loops over what may be empty.

namespace twinmap::algebra {

template <class S>
struct Vec3 {
  S x = 0.0, y = 0.0, z = 0.0;
};

template <class S>
Vec3<S> operator+(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class S>
Vec3<S> operator-(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class S>
Vec3<S> operator-(const Vec3<S>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class S>
Vec3<S> scale(const S& factor, const Vec3<S>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <class S>
S dot(const Vec3<S>& a, const Vec3<S>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S>
Vec3<S> cross(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A matrix by its columns.
template <class S>
struct Mat33 {
  Vec3<S> x, y, z;
};

template <class S>
Vec3<S> operator*(const Mat33<S>& m, const Vec3<S>& v) {
  return {m.x.x * v.x + m.y.x * v.y + m.z.x * v.z, m.x.y * v.x + m.y.y * v.y + m.z.y * v.z,
          m.x.z * v.x + m.y.z * v.y + m.z.z * v.z};
}
template <class S>
Mat33<S> operator*(const Mat33<S>& a, const Mat33<S>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <class S>
Mat33<S> operator+(const Mat33<S>& a, const Mat33<S>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class S>
Mat33<S> operator-(const Mat33<S>& a, const Mat33<S>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class S>
Mat33<S> scale(const S& factor, const Mat33<S>& m) {
  return {scale(factor, m.x), scale(factor, m.y), scale(factor, m.z)};
}
template <class S>
Mat33<S> transpose(const Mat33<S>& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
template <class S>
Mat33<S> makeDiagonal(const S& value) {
  return {{value, 0.0, 0.0}, {0.0, value, 0.0}, {0.0, 0.0, value}};
}
/// a b'
template <class S>
Mat33<S> outer(const Vec3<S>& a, const Vec3<S>& b) {
  return {scale(b.x, a), scale(b.y, a), scale(b.z, a)};
}

/// A rotation about x, y or z.
template <class S>
Mat33<S> rotateX(const S& angle) {
  using std::cos, std::sin;
  const S c = cos(angle), s = sin(angle);
  return {{1.0, 0.0, 0.0}, {0.0, c, s}, {0.0, -s, c}};
}
template <class S>
Mat33<S> rotateY(const S& angle) {
  using std::cos, std::sin;
  const S c = cos(angle), s = sin(angle);
  return {{c, 0.0, -s}, {0.0, 1.0, 0.0}, {s, 0.0, c}};
}
template <class S>
Mat33<S> rotateZ(const S& angle) {
  using std::cos, std::sin;
  const S c = cos(angle), s = sin(angle);
  return {{c, s, 0.0}, {-s, c, 0.0}, {0.0, 0.0, 1.0}};
}
/// Body-fixed x-y-z angles.
template <class S>
Mat33<S> rotateXyz(const Vec3<S>& angles) {
  return rotateX(angles.x) * rotateY(angles.y) * rotateZ(angles.z);
}
/// About a unit vector n (Rodrigues): n n' + cos (1 - n n') + sin [n]x.
template <class S>
Mat33<S> rotateAbout(const Vec3<S>& n, const S& angle) {
  using std::cos, std::sin;
  const S c = cos(angle), s = sin(angle), zero = 0.0;
  const Mat33<S> along = outer(n, n);
  const Mat33<S> turn{{zero, n.z, -n.y}, {-n.z, zero, n.x}, {n.y, -n.x, zero}};
  return along + scale(c, makeDiagonal(S(1.0)) - along) + scale(s, turn);
}

/// A frame in another: p' = rotation * p + origin.
template <class S>
struct Transform {
  Mat33<S> rotation = makeDiagonal(S(1.0));
  Vec3<S> origin;
};

template <class S>
Transform<S> operator*(const Transform<S>& a, const Transform<S>& b) {
  return {a.rotation * b.rotation, a.rotation * b.origin + a.origin};
}
template <class S>
Transform<S> invert(const Transform<S>& a) {
  const Mat33<S> back = transpose(a.rotation);
  return {back, -(back * a.origin)};
}

/// An angular and a linear vector: velocity of a body and its origin, or moment and force.
template <class S>
struct Spatial {
  Vec3<S> angular, linear;
};

template <class S>
Spatial<S> operator+(const Spatial<S>& a, const Spatial<S>& b) {
  return {a.angular + b.angular, a.linear + b.linear};
}
template <class S>
Spatial<S> operator-(const Spatial<S>& a, const Spatial<S>& b) {
  return {a.angular - b.angular, a.linear - b.linear};
}
template <class S>
Spatial<S> scale(const S& factor, const Spatial<S>& a) {
  return {scale(factor, a.angular), scale(factor, a.linear)};
}
/// Power of a force at a velocity.
template <class S>
S dot(const Spatial<S>& a, const Spatial<S>& b) {
  return dot(a.angular, b.angular) + dot(a.linear, b.linear);
}

}  // namespace twinmap::algebra
