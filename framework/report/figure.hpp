#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/report/data_table.hpp"
#include "framework/report/panel.hpp"

namespace twinmap {

/// A choice that the reader makes: "{NAME}", "{NAME.label}" and "{NAME.domain}" in the panels' specifications
/// stand for the chosen option.
struct Choice {
  struct Option {
    std::string value;
    std::string label;
    std::vector<double> domain;  ///< lower and upper bound; empty if it has none
  };
  std::string name;
  std::string label;
  std::vector<Option> options;
  std::size_t chosen = 0;
};

/// A figure: panels side by side under one title, with one sentence on how to read it.
struct Figure {
  std::string name;  ///< letters, digits and '-': its id
  std::string title;
  std::string help;
  std::string table;  ///< its data: the name of a table of the page
  std::vector<Panel> panels;
  std::vector<Choice> choices;
  int columns = 0;  ///< panels side by side where the page is wide; 0: as many as fit
};

/// A chapter of the page: its HTML, in which makeFigureHtml(figure) says where each figure goes.
struct Section {
  std::string id;
  std::string title;
  std::string html;
  std::vector<Figure> figures;
};

/// The smallest and the largest value of an output.
struct OutputRange {
  std::string name;
  double lower = 0.0, upper = 1.0;
};

/// Clean responses of samples, for the page's script to draw those that are highlighted.
struct PackedResponses {
  std::vector<double> times;
  std::vector<OutputRange> outputs;
  std::vector<double> samples;
  int most = 0;  ///< samples that are drawn at a time
  std::string
      data;  ///< base64 of 16-bit fractions of each output's range: sample by sample, output by output
};

/// Everything that is on the page.
struct Page {
  std::string title;
  std::string opening{};  ///< HTML below the title
  std::vector<Section> sections{};
  std::map<std::string, DataTable> tables{};                 ///< data of figures
  std::vector<std::pair<std::string, std::string>> texts{};  ///< name and text that a button copies
  std::optional<std::vector<double>> samples{};              ///< that can be highlighted, if any
  std::optional<PackedResponses> responses{};
};

/// Adds a figure and its place in the section's HTML.
void addFigure(Figure figure, Section& section);

/// The whole page as HTML that needs nothing else.
std::string makePage(const Page& page);

}  // namespace twinmap
