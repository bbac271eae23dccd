#include "framework/export/c_code/c_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace twinmap {
namespace {

constexpr int kPerLine = 6;

/// `values` texts, separated by commas, a few a line.
template <class ToText>
std::string join(std::size_t count, const ToText& to_text) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += i == 0 ? "" : (i % kPerLine == 0 ? ",\n  " : ", ");
    text += to_text(i);
  }
  return text;
}

}  // namespace

std::string toC(double value, CNumber number) {
  if (!std::isfinite(value)) {
    throw std::runtime_error("a constant of the map is not finite");
  }
  const bool single = number == CNumber::kSingle;
  std::string text =
      single ? fmt::format("{:.9g}", static_cast<float>(value)) : fmt::format("{:.17g}", value);
  if (text.find_first_of(".e") == std::string::npos) {
    text += ".0";
  }
  return single ? text + "f" : text;
}

std::string toUpper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string quoteC(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || c == '?') {  // "??" may begin a trigraph
      quoted += std::string("\\") + c;
    } else if (byte < 0x20 || byte >= 0x7f) {
      quoted += fmt::format("\\{:03o}", byte);
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

Eigen::VectorXd flattenColumns(const Eigen::MatrixXd& matrix) {
  return Eigen::Map<const Eigen::VectorXd>(matrix.data(), matrix.size());
}

Eigen::VectorXd flattenRows(const Eigen::MatrixXd& matrix) {
  return flattenColumns(matrix.transpose());
}

void CTables::addArray(const char* type, const std::string& name,
                       const Eigen::Ref<const Eigen::VectorXd>& values, const std::string& meaning,
                       CNumber number) {
  const auto count = static_cast<std::size_t>(values.size());
  text_ += fmt::format(
      "/* {} */\nstatic const {} {}[{}] = {{\n  {}}};\n\n", meaning, type, name, count,
      join(count, [&](std::size_t i) { return toC(values(static_cast<Eigen::Index>(i)), number); }));
  bytes_ += count * (number == CNumber::kSingle ? sizeof(float) : sizeof(double));
}

void CTables::addWide(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
                      const std::string& meaning) {
  addArray("double", name, values, meaning, CNumber::kDouble);
}

void CTables::addReal(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
                      const std::string& meaning) {
  addArray("real_t", name, values, meaning, storage_);
}

void CTables::addInts(const std::string& name, const std::vector<int>& values, const std::string& meaning) {
  text_ += fmt::format("/* {} */\nstatic const int {}[{}] = {{\n  {}}};\n\n", meaning, name, values.size(),
                       join(values.size(), [&](std::size_t i) { return std::to_string(values[i]); }));
  bytes_ += values.size() * sizeof(int);
}

void CTables::addNumber(const std::string& name, double value, const std::string& meaning) {
  text_ += fmt::format("/* {} */\nstatic const double {} = {};\n\n", meaning, name, toC(value));
  bytes_ += sizeof(double);
}

void CTables::addStructs(const std::string& type, const std::string& name,
                         const std::vector<std::string>& entries, const std::string& meaning) {
  text_ += fmt::format("/* {} */\nstatic const {} {}[{}] = {{\n", meaning, type, name, entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    text_ += "  {" + entries[i] + (i + 1 < entries.size() ? "},\n" : "}\n");
  }
  text_ += "};\n\n";
}

void CTables::addStrings(const std::string& name, const std::vector<std::string>& texts,
                         const std::string& meaning) {
  text_ += fmt::format("/* {} */\nconst char *const {}[{}] = {{\n  {}}};\n\n", meaning, name, texts.size(),
                       join(texts.size(), [&](std::size_t i) { return quoteC(texts[i]); }));
}

}  // namespace twinmap
