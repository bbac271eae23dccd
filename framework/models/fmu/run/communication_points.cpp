#include "framework/models/fmu/run/communication_points.hpp"

#include <algorithm>
#include <cmath>

#include "framework/models/fmu/instance/failure.hpp"

namespace twinmap::fmi {
namespace {

/// Times of decimal files agree to rounding only; this share of the last target is far above it and far below
/// a step.
constexpr double kAgreement = 1e-9;

double calcCommonDivisor(double a, double b, double tolerance) {
  while (b > tolerance) {
    const double rest = a - b * std::floor(a / b + tolerance / b);
    a = b;
    b = std::max(rest, 0.0);
  }
  return a;
}

long countPieces(double length, double largest) {
  return std::max(1L, static_cast<long>(std::ceil(length / largest * (1.0 - kAgreement))));
}

bool areMultiples(const std::vector<double>& targets, double step) {
  return std::all_of(targets.begin(), targets.end(), [&](double target) {
    return std::abs(target / step - std::round(target / step)) * step < kAgreement * targets.back();
  });
}

CommunicationGrid calcFixedGrid(const std::vector<double>& targets, double largest) {
  constexpr double kSmallestShare = 1e-6;
  const double last = targets.back();
  double divisor = targets.front();
  for (const double target : targets) {
    divisor = calcCommonDivisor(target, divisor, kAgreement * last);
  }
  if (divisor < kSmallestShare * last) {
    throw FmuFailure(
        "the FMU takes communication steps of one size only, and no step meets all sample times and edges of "
        "the excitation; make them multiples of one step");
  }
  CommunicationGrid grid;
  grid.step = divisor / static_cast<double>(countPieces(divisor, largest));
  const long count = std::lround(last / grid.step);
  for (long i = 0; i <= count; ++i) {
    grid.points.push_back(static_cast<double>(i) * grid.step);
  }
  return grid;
}

/// From `begin` to `end` in steps of whole `unit`s.
void appendWholeSteps(double begin, double end, double largest, double unit, std::vector<double>& points) {
  const long units = std::lround((end - begin) / unit);
  const long most = std::max(1L, static_cast<long>(std::floor(largest / unit * (1.0 + kAgreement))));
  const long pieces = (units + most - 1) / most;
  for (long i = 1; i < pieces; ++i) {
    points.push_back(begin + static_cast<double>(units * i / pieces) * unit);
  }
  points.push_back(end);
}

void appendEvenSteps(double begin, double end, double largest, std::vector<double>& points) {
  const long pieces = countPieces(end - begin, largest);
  for (long i = 1; i < pieces; ++i) {
    points.push_back(begin + (end - begin) * static_cast<double>(i) / static_cast<double>(pieces));
  }
  points.push_back(end);
}

}  // namespace

CommunicationGrid calcCommunicationGrid(const std::vector<double>& targets, double largest,
                                        const Capabilities& capabilities) {
  CommunicationGrid grid{{0.0}, 0.0};
  if (targets.empty()) {
    return grid;
  }
  if (!capabilities.variable_step) {
    return calcFixedGrid(targets, largest);
  }
  const double unit = capabilities.internal_step.value_or(0.0);
  const bool whole = unit > 0.0 && areMultiples(targets, unit);
  for (const double target : targets) {
    const double begin = grid.points.back();
    whole ? appendWholeSteps(begin, target, largest, unit, grid.points)
          : appendEvenSteps(begin, target, largest, grid.points);
  }
  return grid;
}

}  // namespace twinmap::fmi
