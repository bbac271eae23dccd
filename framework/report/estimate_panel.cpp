#include "framework/report/estimate_panel.hpp"

#include <algorithm>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

constexpr int kRowHeight = 54, kFrame = 10;  // a bar between two lines of text

std::string describeBounds(const Bounds& bounds) {
  constexpr int kDigits = 4;
  return toShortText(bounds.lower, kDigits) + " .. " + toShortText(bounds.upper, kDigits);
}

std::string describeEstimate(const ShownEstimate& shown) {
  constexpr int kDigits = 5, kStddevDigits = 2;
  return toShortText(shown.mean, kDigits) + " \u00b1 " + toShortText(shown.stddev, kStddevDigits);
}

DataTable makeTable(const std::vector<ParameterSpec>& parameters,
                    const std::vector<ShownEstimate>& estimates) {
  std::vector<std::string> labels, bounds, texts;
  std::vector<double> from, at, to, truth;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Bounds& within = parameters[p].bounds;
    const auto place = [&](double value) {
      return std::clamp((value - within.lower) / (within.upper - within.lower), 0.0, 1.0);
    };
    labels.push_back(makeLabel(parameters[p]));
    bounds.push_back(describeBounds(within));
    texts.push_back(describeEstimate(estimates[p]));
    from.push_back(place(estimates[p].lower95));
    at.push_back(place(estimates[p].mean));
    to.push_back(place(estimates[p].upper95));
    truth.push_back(place(estimates[p].truth.value_or(estimates[p].mean)));
  }
  DataTable table;
  table.add("parameter", std::move(labels));
  table.add("bounds", std::move(bounds));
  table.add("estimate", std::move(texts));
  table.add("from", std::move(from));
  table.add("at", std::move(at));
  table.add("to", std::move(to));
  table.add("truth", std::move(truth));
  return table;
}

}  // namespace

Figure makeEstimateFigure(const std::string& name, const std::string& title,
                          const std::vector<ParameterSpec>& parameters,
                          const std::vector<ShownEstimate>& estimates, Page& page) {
  page.tables[name] = makeTable(parameters, estimates);
  const bool has_truth = !estimates.empty() && estimates.front().truth.has_value();
  Panel panel{
      "intervals", {{"table", name}}, {{"height", calcHeight(parameters.size(), kRowHeight, kFrame)}}};
  if (!has_truth) {
    panel.without.insert("truth");
  }
  return {name,
          title,
          std::string("Grey: the bounds, from the lower at 0 to the upper at 1. Blue: the 95 % interval, and "
                      "the estimate. ") +
              (has_truth ? "The tick is the true value." : ""),
          name,
          {std::move(panel)},
          {},
          1};
}

}  // namespace twinmap
