#pragma once

#include <string>
#include <vector>

#include "framework/report/figure.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

// Pieces of Vega-Lite specifications. Colours are custom properties of the page's style sheet, so that one
// specification serves light, dark and print.

/// {"field": .., "type": "quantitative", "title": ..} and whatever `more` adds or replaces.
Json makeQuantitative(const std::string& field, const std::string& title, const Json& more = Json::object());
Json makeNominal(const std::string& field, const std::string& title, const Json& more = Json::object());

/// {"scale": {"domain": [lower, upper], "nice": false, "zero": false}}.
Json makeDomain(double lower, double upper);
/// {"scale": {"zero": false}}.
Json makeFreeScale();
/// A logarithmic scale that ends a little beyond its data.
Json makeLogScale();

/// The start of every panel: data, size, and the parameter `selected` through which the page's script says
/// which samples are highlighted.
Json makePanelSpec(const std::string& table, int height);

/// Selecting by dragging a rectangle; the script reads it.
Json makeBrush();

/// True for samples that are highlighted, or for all if none is.
inline constexpr const char* kIsSelected = "!selected || selected[datum.sample]";

/// The colour of a parameter, the same in every figure: Okabe and Ito's, safe for the colour blind.
std::string getColor(std::size_t index);
/// Dashes that tell lines apart without colour.
Json getDash(std::size_t index);
/// {"scale": {"domain": names, "range": colours}}, and the same with dashes.
Json makeColorScale(const std::vector<std::string>& names);
Json makeDashScale(const std::vector<std::string>& names);

/// "k_y [N/m]".
std::string makeLabel(const std::string& name, const std::string& unit);
std::string makeLabel(const ParameterSpec& parameter);

}  // namespace twinmap
