#include "framework/report/sections/sweep_figures.hpp"

#include <set>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

Choice makeChoice(const std::string& name, const std::string& label, const std::vector<std::string>& values) {
  Choice choice{name, label, {}, 0};
  for (const std::string& value : values) {
    choice.options.push_back({value, value.empty() ? "as in the file" : value, {}});
  }
  return choice;
}

std::vector<std::string> toTexts(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) {
    texts.push_back(toText(value));
  }
  return texts;
}

/// What a figure of curves has on its horizontal axis, and what else the sweep varied.
struct CurveAxes {
  std::string x, x_title;
  std::string other, other_title;  ///< what is not on the axis
  std::vector<double> others;      ///< its values; none if the sweep did not vary it
};

CurveAxes makeCurveAxes(const SweepAxes& axes, bool over_size) {
  return over_size ? CurveAxes{"size", "training samples", "noise", "noise scale", axes.noises}
                   : CurveAxes{"noise", "noise scale", "size", "training samples", axes.sizes};
}

/// Slots of the skeleton that curves by variant, or by the other axis, do not have.
std::set<std::string> findMissingSlots(const SweepAxes& axes, const CurveAxes& curves) {
  const bool by_variant = axes.variants.size() > 1;
  std::set<std::string> missing{by_variant ? "grouped" : "chosen"};
  if (curves.others.empty()) {
    missing.insert(by_variant ? "chosen" : "colors");
  }
  if (!axes.has_limits) {
    missing.insert("limit");
  }
  return missing;
}

/// The curves of one parameter: a line per variant, or per value of `other` if there is one variant only.
Panel makeCurves(const SweepAxes& axes, const CurveAxes& curves, const std::string& parameter) {
  const bool by_variant = axes.variants.size() > 1;
  const SlotValue none = nullptr;
  Panel panel{"error-curves",
              {{"parameter", parameter},
               {"x", curves.x},
               {"x_title", curves.x_title},
               {"grouping", curves.other},
               {"series", by_variant ? "variant" : curves.other}},
              {{"series", by_variant ? axes.variants : toTexts(curves.others)},
               {"series_title", by_variant ? none : curves.other_title}},
              findMissingSlots(axes, curves)};
  if (!by_variant && curves.others.empty()) {  // a single line
    panel.values["legends"] = none;
  }
  return panel;
}

Figure makeSweepFigure(const std::string& name, const std::string& title, const std::string& help) {
  constexpr int kColumns = 2;
  return {name, title, help, kSweepTable, {}, {}, kColumns};
}

}  // namespace

Figure makeCurveFigure(const SweepAxes& axes, bool over_size) {
  const CurveAxes curves = makeCurveAxes(axes, over_size);
  Figure figure = makeSweepFigure(
      "error-over-" + curves.x, "Error against " + curves.x_title,
      std::string(
          "Each line is the mean over the seeds, its band reaches from the lowest to the highest seed") +
          (axes.has_limits ? "; dotted: the information limit, below which no estimator can come." : "."));
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back(makeCurves(axes, curves, parameter));
  }
  if (axes.variants.size() > 1 && !curves.others.empty()) {
    figure.choices.push_back(makeChoice("other", curves.other_title, toTexts(curves.others)));
  }
  return figure;
}

Figure makeHeatMapFigure(const SweepAxes& axes) {
  constexpr int kRowHeight = 30, kFrame = 20;
  Figure figure = makeSweepFigure(
      "size-noise", "Size against noise",
      "The mean sd of the relative error in %: along a row the gain from more simulations, along a column "
      "the gain from better sensors.");
  const double height = calcHeight(axes.noises.size(), kRowHeight, kFrame);
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back({"size-noise", {{"parameter", parameter}}, {{"height", height}}});
  }
  figure.choices = {makeChoice("variant", "inverse map", axes.variants)};
  return figure;
}

Figure makeVariantFigure(const SweepAxes& axes) {
  constexpr int kRowHeight = 26, kFrame = 20;
  Figure figure = makeSweepFigure(
      "variants", "Error of each variant",
      "The mean over the seeds, its bar from the lowest to the highest seed; the tick is the information "
      "limit.");
  const double height = calcHeight(axes.variants.size(), kRowHeight, kFrame);
  for (const std::string& parameter : axes.parameters) {
    figure.panels.push_back({"variants", {{"parameter", parameter}}, {{"height", height}}});
    if (!axes.has_limits) {
      figure.panels.back().without = {"limit"};
    }
  }
  return figure;
}

}  // namespace twinmap
