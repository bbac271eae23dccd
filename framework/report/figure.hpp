#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "framework/report/data_table.hpp"

namespace twinmap {

using Json = nlohmann::ordered_json;

/// One drawing of a figure: a Vega-Lite specification whose data names tables of the page.
struct Panel {
  std::string alt;  ///< what a reader who cannot see it should know
  Json spec;
};

/// A choice that the reader makes: "{NAME}", "{NAME.label}" and "{NAME.domain}" in the panels' specifications
/// stand for the chosen option.
struct Choice {
  struct Option {
    std::string value;
    std::string label;
    Json domain;
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

/// Everything that is on the page.
struct Page {
  std::string title;
  std::vector<Section> sections;
  std::map<std::string, DataTable> tables;                 ///< data of figures
  std::vector<std::pair<std::string, std::string>> texts;  ///< name and text that a button copies
  Json extras = Json::object();                            ///< further data for the page's script
};

/// Adds a figure and its place in the section's HTML.
void addFigure(Figure figure, Section& section);

/// The whole page as HTML that needs nothing else.
std::string makePage(const Page& page);

}  // namespace twinmap
