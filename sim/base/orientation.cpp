#include "sim/base/orientation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pneuma::base {
namespace {

/// Half the distance from 1 to the next double: the relative error of one rounding.
constexpr double half_ulp = 0x1p-53;

template <class Number>
int sign_of(const Number& value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// A number as the sum of two doubles, the second being what rounding left of it.
struct TwoDoubles {
  double high;
  double low;
};

TwoDoubles exact_sum(double a, double b) {  // Knuth
  const double sum = a + b;
  const double b_in_sum = sum - a;
  const double a_in_sum = sum - b_in_sum;
  return {sum, (a - a_in_sum) + (b - b_in_sum)};
}

TwoDoubles exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

// J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
// predicates", Discrete & Computational Geometry 18 (1997): an expansion is a number as the sum of
// doubles that do not overlap, in ascending size, so that its sign is the sign of the last. To add
// a double, it is pushed through them from the least on, each leaving its rounding error behind
// (theorem 10). Here zeros are dropped. The determinant of three differences has at most 192 terms:
// a difference has 2, a product of two 8, the difference of two of those 16, times a third
// difference 64, and three of those are summed up.
class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(TwoDoubles value) {
    add(value.low);
    add(value.high);
  }

  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const TwoDoubles sum = exact_sum(value, terms_[i]);
      if (sum.low != 0.0) terms_[kept++] = sum.low;
      value = sum.high;
    }
    if (value != 0.0) terms_[kept++] = value;
    size_ = kept;
  }

  /// Adds factor * a * b.
  void add_product(const Expansion& a, const Expansion& b, double factor) {
    for (std::size_t i = 0; i < a.size_; ++i) {
      for (std::size_t j = 0; j < b.size_; ++j) {
        const TwoDoubles product = exact_product(factor * a.terms_[i], b.terms_[j]);
        add(product.low);
        add(product.high);
      }
    }
  }

  int sign() const { return size_ == 0 ? 0 : sign_of(terms_[size_ - 1]); }

 private:
  std::array<double, 192> terms_;
  std::size_t size_ = 0;
};

using ExactVector = std::array<Expansion, 3>;

ExactVector exact_difference(const Point& a, const Point& b) {
  return {Expansion(exact_sum(a[0], -b[0])), Expansion(exact_sum(a[1], -b[1])),
          Expansion(exact_sum(a[2], -b[2]))};
}

/// One component of a cross product.
Expansion exact_cross(const ExactVector& a, const ExactVector& b, std::size_t axis) {
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  Expansion cross;
  cross.add_product(a[y], b[z], 1.0);
  cross.add_product(a[z], b[y], -1.0);
  return cross;
}

int exact_determinant_sign(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
  Expansion determinant;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    determinant.add_product(exact_cross(a, b, axis), c[axis], 1.0);
  }
  return determinant.sign();
}

bool is_finite(const Point& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

/// The sign of the volume of p q a b, with the segment p q shifted as Passage says where it is 0.
///
/// With D = q - p and a shift s the volume is det(D, a - p - s, b - p - s)
///   = det(D, a - p, b - p) + s . (D x (b - a)),
/// so that the first component of D x (b - a) that is not 0 decides. If all of them are 0, p and q
/// lie on the line a b: then they are on the triangle's plane, and nobody asks.
int side_of_line(const Point& p, const Point& q, const Point& a, const Point& b, bool& meets) {
  const int side = -side_of_plane(p, q, a, b);
  meets = side == 0;
  if (!meets) return side;
  const ExactVector along = exact_difference(q, p), edge = exact_difference(b, a);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const int sign = exact_cross(along, edge, axis).sign(); sign != 0) return sign;
  }
  return 0;
}

}  // namespace

// The filter. On its way into the determinant each of the six products of three differences is
// rounded at most 8 times: three differences, a product, a difference of two, a product, two sums.
// So the error is at most ((1 + u)^8 - 1) of the sum of their sizes, u = 2^-53; that sum is itself
// rounded 8 times at most, downwards to (1 - u)^8 of itself. 9 u covers both. Underflow would add
// up to 2^-1074 a product, far below 9 u of 1e-250.
int side_of_plane(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
  const double cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
  const double dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];
  const double determinant =
      dx * (by * cz - bz * cy) + dy * (bz * cx - bx * cz) + dz * (bx * cy - by * cx);
  const double sizes = std::abs(dx) * (std::abs(by * cz) + std::abs(bz * cy)) +
                       std::abs(dy) * (std::abs(bz * cx) + std::abs(bx * cz)) +
                       std::abs(dz) * (std::abs(bx * cy) + std::abs(by * cx));
  if (sizes > 1e-250 && std::abs(determinant) > 9.0 * half_ulp * sizes) {
    return -sign_of(determinant);
  }
  if (!is_finite(a) || !is_finite(b) || !is_finite(c) || !is_finite(d)) return 0;
  return -exact_determinant_sign(exact_difference(b, a), exact_difference(c, a),
                                 exact_difference(d, a));
}

Passage find_passage(const Point& p, const Point& q, const Point& a, const Point& b,
                     const Point& c) {
  const int p_side = side_of_plane(a, b, c, p);
  const int q_side = side_of_plane(a, b, c, q);
  Passage passage;
  passage.in_plane = p_side == 0 && q_side == 0;
  if (p_side * q_side >= 0) return passage;
  auto& meets = passage.meets_side;
  const int ab = side_of_line(p, q, a, b, meets[0]);
  if (side_of_line(p, q, b, c, meets[1]) != ab) return {};
  if (side_of_line(p, q, c, a, meets[2]) != ab) return {};
  passage.direction = p_side;
  return passage;
}

}  // namespace pneuma::base
