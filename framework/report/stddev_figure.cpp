#include "framework/report/stddev_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "framework/report/escape.hpp"
#include "framework/spec/number_text.hpp"

namespace twinmap {
namespace {

// Lengths in SVG user units.
constexpr double kWidth = 460.0, kHeight = 340.0;
constexpr double kLeft = 62.0, kRight = 352.0, kTop = 34.0, kBottom = 290.0;
constexpr double kBarLeft = 376.0, kBarWidth = 14.0;
constexpr int kTicks = 5;
constexpr int kTickDigits = 3;

struct Interval {
  double lower, upper;

  double toFraction(double value) const { return upper > lower ? (value - lower) / (upper - lower) : 0.5; }
  double fromFraction(double fraction) const { return lower + fraction * (upper - lower); }
};

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

/// Viridis (S. van der Walt, N. Smith, CC0) at five equidistant points, linear between: perceptually uniform
/// and safe for the colour blind.
std::string makeColor(double fraction) {
  constexpr std::array<std::array<double, 3>, 5> kStops{
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double position = std::clamp(fraction, 0.0, 1.0) * (kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  const double weight = position - static_cast<double>(below);
  std::array<int, 3> rgb{};
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    rgb[i] = static_cast<int>(std::lround((1 - weight) * kStops[below][i] + weight * kStops[below + 1][i]));
  }
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
  return text.data();
}

std::string makeLabel(const ParameterSpec& parameter) {
  return parameter.name.text + (parameter.unit.empty() ? "" : " [" + parameter.unit + "]");
}

std::string makeText(double x, double y, const std::string& anchor, const std::string& text,
                     const std::string& more = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
         escapeHtml(text) + "</text>\n";
}

std::string makeLine(double x1, double y1, double x2, double y2) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" +
         number(y2) + "\"/>\n";
}

std::string makeAxes(const ParameterSpec& horizontal, const ParameterSpec& vertical) {
  std::string svg = "<g stroke=\"currentColor\" stroke-width=\"1\">\n" +
                    makeLine(kLeft, kBottom, kRight, kBottom) + makeLine(kLeft, kTop, kLeft, kBottom) +
                    "</g>\n";
  const Interval x{horizontal.bounds.lower, horizontal.bounds.upper};
  const Interval y{vertical.bounds.lower, vertical.bounds.upper};
  constexpr double kTickGap = 8.0, kTextDrop = 4.0;
  for (int i = 0; i < kTicks; ++i) {
    const double fraction = i / (kTicks - 1.0);
    svg += makeText(kLeft + fraction * (kRight - kLeft), kBottom + 2 * kTickGap, "middle",
                    toShortText(x.fromFraction(fraction), kTickDigits));
    svg += makeText(kLeft - kTickGap, kBottom - fraction * (kBottom - kTop) + kTextDrop, "end",
                    toShortText(y.fromFraction(fraction), kTickDigits));
  }
  const double middle = 0.5 * (kTop + kBottom);
  return svg + makeText(0.5 * (kLeft + kRight), kBottom + 36, "middle", makeLabel(horizontal)) +
         makeText(14, middle, "middle", makeLabel(vertical),
                  " transform=\"rotate(-90 14 " + number(middle) + ")\"");
}

std::string makeColorBar(const Interval& stddev) {
  constexpr int kSlices = 64;
  const double slice = (kBottom - kTop) / kSlices;
  std::string svg;
  for (int i = 0; i < kSlices; ++i) {
    svg += "<rect x=\"" + number(kBarLeft) + "\" y=\"" + number(kBottom - (i + 1) * slice) + "\" width=\"" +
           number(kBarWidth) + "\" height=\"" + number(slice + 0.5) + "\" fill=\"" +
           makeColor((i + 0.5) / kSlices) + "\"/>\n";
  }
  for (int i = 0; i < kTicks; ++i) {
    const double fraction = i / (kTicks - 1.0);
    svg += makeText(kBarLeft + kBarWidth + 6, kBottom - fraction * (kBottom - kTop) + 4, "start",
                    toShortText(stddev.fromFraction(fraction), kTickDigits));
  }
  return svg;
}

std::string makePoints(const RunSummary& run, int parameter, const Interval& stddev) {
  const int h = run.axes[0], v = run.axes[1];
  const Interval x{run.parameters[h].bounds.lower, run.parameters[h].bounds.upper};
  const Interval y{run.parameters[v].bounds.lower, run.parameters[v].bounds.upper};
  std::string svg;
  for (Eigen::Index i = 0; i < run.truth.cols(); ++i) {
    const double value = run.predictions.stddev(parameter, i);
    svg += "<circle cx=\"" + number(kLeft + x.toFraction(run.truth(h, i)) * (kRight - kLeft)) + "\" cy=\"" +
           number(kBottom - y.toFraction(run.truth(v, i)) * (kBottom - kTop)) + "\" r=\"3.2\" fill=\"" +
           makeColor(stddev.toFraction(value)) + "\"><title>" +
           escapeHtml("sample " + std::to_string(run.test_indices[i]) + ": sd " +
                      toShortText(value, kTickDigits)) +
           "</title></circle>\n";
  }
  return svg;
}

}  // namespace

std::string makeStddevFigure(const RunSummary& run, int parameter) {
  const auto values = run.predictions.stddev.row(parameter);
  const Interval stddev{values.minCoeff(), values.maxCoeff()};
  const std::string title = "Inferred standard deviation of " + makeLabel(run.parameters[parameter]);
  const std::string background = "<rect width=\"100%\" height=\"100%\" fill=\"var(--paper, #fff)\"/>\n";
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + " " + number(kHeight) +
         "\" role=\"img\" aria-label=\"" + escapeHtml(title) +
         "\" font-family=\"system-ui, sans-serif\" font-size=\"11\" fill=\"currentColor\">\n" + background +
         makeText(kLeft, 18, "start", title, " font-size=\"13\" font-weight=\"600\"") +
         makeAxes(run.parameters[run.axes[0]], run.parameters[run.axes[1]]) +
         makePoints(run, parameter, stddev) + makeColorBar(stddev) + "</svg>\n";
}

}  // namespace twinmap
