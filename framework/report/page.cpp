#include <fmt/core.h>

#include <algorithm>

#include "framework/base/json/json.hpp"
#include "framework/report/assets.hpp"
#include "framework/report/figure.hpp"
#include "framework/report/html.hpp"
#include "framework/report/skeleton.hpp"

namespace twinmap {
namespace {

/// JSON for a script element: "<" is written so that no text can end the element or open a comment.
std::string dumpForScript(const Json& json) {
  const std::string text = formatJson(json);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string makeChoiceHtml(const Figure& figure, const Choice& choice) {
  std::string options;
  for (std::size_t i = 0; i < choice.options.size(); ++i) {
    options += makeElement("option", escapeHtml(choice.options[i].label),
                           fmt::format("value=\"{}\"{}", i, i == choice.chosen ? " selected" : ""));
  }
  const std::string select = makeElement(
      "select", options,
      "data-figure=\"" + escapeHtml(figure.name) + "\" data-choice=\"" + escapeHtml(choice.name) + "\"");
  return makeElement("label", escapeHtml(choice.label) + " " + select);
}

std::string makeChoicesHtml(const Figure& figure) {
  std::string html;
  for (const Choice& choice : figure.choices) {
    html += makeChoiceHtml(figure, choice);
  }
  return html.empty() ? "" : makeElement("div", html, "class=\"choices\"") + "\n";
}

std::string makeFigureHtml(const Figure& figure) {
  const std::string name = escapeHtml(figure.name);
  std::string panels;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    panels += fmt::format("<div class=\"panel\" id=\"{}-{}\" role=\"img\" aria-label=\"{}\"></div>\n", name,
                          i, escapeHtml(describePanel(figure.panels[i])));
  }
  const std::string columns = figure.columns > 0 ? fmt::format(" columns-{}", figure.columns) : "";
  const std::string data = makeElement("button", "CSV",
                                       "type=\"button\" class=\"quiet\" data-table=\"" +
                                           escapeHtml(figure.table) + "\" title=\"Save this figure's data\"");
  return "<figure id=\"" + name + "\">\n" + makeElement("h3", escapeHtml(figure.title) + " " + data) + "\n" +
         makeChoicesHtml(figure) + "<div class=\"panels" + columns + "\">\n" + panels + "</div>\n" +
         makeElement("figcaption", escapeHtml(figure.help)) + "\n</figure>\n";
}

Json toJson(const Choice& choice) {
  Json options = Json::array();
  for (const Choice::Option& option : choice.options) {
    const Json domain = option.domain.empty() ? Json(nullptr) : Json(option.domain);
    options.push_back({{"value", option.value}, {"label", option.label}, {"domain", domain}});
  }
  return {{"name", choice.name}, {"chosen", choice.chosen}, {"options", options}};
}

Json toJson(const Figure& figure) {
  Json panels = Json::array(), choices = Json::array();
  for (const Panel& panel : figure.panels) {
    panels.push_back(makeSpec(panel));
  }
  for (const Choice& choice : figure.choices) {
    choices.push_back(toJson(choice));
  }
  return {{"name", figure.name}, {"table", figure.table}, {"panels", panels}, {"choices", choices}};
}

Json toJson(const PackedResponses& responses) {
  Json outputs = Json::array();
  for (const OutputRange& output : responses.outputs) {
    outputs.push_back({{"name", output.name}, {"lower", output.lower}, {"upper", output.upper}});
  }
  return {{"times", responses.times},
          {"outputs", outputs},
          {"samples", responses.samples},
          {"most", responses.most},
          {"data", responses.data}};
}

Json makePageData(const Page& page) {
  Json data{{"tables", Json::object()}, {"texts", Json::object()}, {"figures", Json::array()}};
  for (const auto& [name, table] : page.tables) {
    data["tables"][name] = table.toJson();
  }
  for (const auto& [name, text] : page.texts) {
    data["texts"][name] = text;
  }
  for (const Section& section : page.sections) {
    for (const Figure& figure : section.figures) {
      data["figures"].push_back(toJson(figure));
    }
  }
  if (page.samples) {
    data["samples"] = *page.samples;
  }
  if (page.responses) {
    data["responses"] = toJson(*page.responses);
  }
  return data;
}

std::string makeContents(const Page& page) {
  std::string items;
  for (const Section& section : page.sections) {
    items += makeElement("li", makeElement("a", escapeHtml(section.title), "href=\"#" + section.id + "\""));
  }
  return makeElement("nav", makeElement("ol", items), "aria-label=\"Contents\"") + "\n";
}

/// extra: between the heading and what follows.
std::string makeSectionHtml(const Section& section, const std::string& extra) {
  const std::string heading =
      makeElement("h2", escapeHtml(section.title), "id=\"heading-" + section.id + "\"");
  return "<section id=\"" + section.id + "\" aria-labelledby=\"heading-" + section.id + "\">\n" + heading +
         "\n" + extra + section.html + "</section>\n";
}

std::string makeScript(std::string_view text) {
  return "<script>" + std::string(text) + "</script>\n";
}

/// The bar that says which samples are highlighted, above the figures of test samples; the script shows it
/// where there are samples, and at the window's edge while some are highlighted.
constexpr const char* kSelectionBar =
    R"(<div class="selection-place"><div id="selection" role="region" aria-label="Highlighted samples" hidden>
<label>Highlight sample <input id="sample" type="number" min="0" step="1"></label>
<span id="selection-text" role="status"></span>
<button type="button" id="clear">Clear</button>
</div></div>
)";

bool showsSamples(const Section& section) {
  return std::any_of(section.figures.begin(), section.figures.end(),
                     [](const Figure& figure) { return figure.table == "samples"; });
}

}  // namespace

void addFigure(Figure figure, Section& section) {
  section.html += makeFigureHtml(figure);
  section.figures.push_back(std::move(figure));
}

std::string makePage(const Page& page) {
  std::string body = makeElement("header", makeElement("h1", escapeHtml(page.title))) + "\n" + page.opening;
  const auto selects = std::find_if(page.sections.begin(), page.sections.end(), showsSamples);
  for (auto section = page.sections.begin(); section != page.sections.end(); ++section) {
    body += makeSectionHtml(*section, section == selects ? kSelectionBar : "") +
            (section == page.sections.begin() ? makeContents(page) : "");
  }
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"color-scheme\" content=\"light dark\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n" +
         makeElement("title", escapeHtml(page.title) + " - twinmap") + "\n" +
         makeElement("style", std::string(getReportStyle())) + "\n</head>\n<body>\n<main>\n" + body +
         "<noscript><p>The figures of this page are drawn by its own script, which is switched off.</p>"
         "</noscript>\n" +
         "</main>\n<script type=\"application/json\" id=\"page-data\">" + dumpForScript(makePageData(page)) +
         "</script>\n" + makeScript(getVegaScript()) + makeScript(getVegaLiteScript()) +
         makeScript(getVegaEmbedScript()) + makeScript(getReportScript()) + "</body>\n</html>\n";
}

}  // namespace twinmap
