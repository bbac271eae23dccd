#include "framework/serve/live/posted_measurement.hpp"

#include <algorithm>

#include "framework/base/json/json.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap::serve {
namespace {

[[noreturn]] void throwBody(const std::string& key, const std::string& rule) {
  throw ExperimentError("the body's '" + key + "' " + rule +
                        "\n  a measurement is {\"columns\": {\"t\": [0, 0.1], \"x\": [1.5, null]}}, and "
                        "perhaps \"at\", \"trial\" and \"name\"");
}

/// What nests deeper than a measurement would take many times its length to read.
void requireFlat(const std::string& body) {
  constexpr int kDeepest = 3;  // the whole, its columns, their cells
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const char c = body[i];
    if (c == '"' || (in_text && c == '\\')) {
      in_text = c == '"' ? !in_text : in_text;
      i += c == '\\' ? 1 : 0;
    } else if (!in_text && (c == '{' || c == '[') && ++depth > kDeepest) {
      throw ExperimentError("the body nests deeper than {\"columns\": {\"t\": [0, 0.1]}}");
    } else if (!in_text && (c == '}' || c == ']')) {
      --depth;
    }
  }
}

std::string readText(const Json& value, const std::string& key) {
  if (value.is_number()) {
    return toText(value.get<double>());
  }
  if (!value.is_string()) {
    throwBody(key, "must be a text" + std::string(key == "at" ? " or a number" : ""));
  }
  return value.get<std::string>();
}

std::size_t countRows(const Json& columns) {
  if (!columns.is_object() || columns.empty()) {
    throwBody("columns", "must be an object with at least one column");
  }
  const std::size_t rows = columns.begin()->size();
  for (const auto& [name, cells] : columns.items()) {
    if (!cells.is_array()) {
      throwBody("columns." + name, "must be an array of numbers");
    }
    if (cells.size() != rows) {
      throwBody("columns." + name, "has " + std::to_string(cells.size()) + " cells, and the first column " +
                                       std::to_string(rows) + "; all must have as many");
    }
  }
  return rows;
}

std::string writeCell(const Json& cell, const std::string& name, std::size_t row) {
  if (cell.is_null()) {
    return "nan";
  }
  if (!cell.is_number()) {
    throwBody("columns." + name + "[" + std::to_string(row) + "]", "must be a number or null");
  }
  return toText(cell.get<double>());
}

std::string writeCsv(const Json& columns) {
  const std::size_t rows = countRows(columns);
  std::string text;
  for (const auto& [name, cells] : columns.items()) {
    text += (text.empty() ? "" : ",") + escapeCsv(name);
  }
  text += '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    const char* separator = "";
    for (const auto& [name, cells] : columns.items()) {
      text += separator + writeCell(cells[row], name, row);
      separator = ",";
    }
    text += '\n';
  }
  return text;
}

}  // namespace

PostedMeasurement readPostedJson(const std::string& body) {
  requireFlat(body);
  Json json;
  try {
    json = parseJson(body);
  } catch (const Json::exception& error) {
    throw NotJson("the body cannot be read as JSON: " + std::string(error.what()));
  }
  if (!json.is_object() || !json.contains("columns")) {
    throwBody("columns", "is missing");
  }
  PostedMeasurement posted;
  for (const auto& [key, value] : json.items()) {
    if (key == "columns") {
      posted.text = writeCsv(value);
    } else if (key == "at") {
      posted.at = readText(value, key);
    } else if (key == "trial" || key == "name") {
      (key == "trial" ? posted.trial : posted.name) = readText(value, key);
    } else {
      throwBody(key, "is not known");
    }
  }
  return posted;
}

PostedMeasurement readPostedText(std::string body) {
  const std::size_t first = body.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && body[first] == '{') {
    return readPostedJson(body);
  }
  PostedMeasurement posted;
  posted.text = std::move(body);
  return posted;
}

}  // namespace twinmap::serve
