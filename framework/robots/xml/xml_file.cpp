#include "framework/robots/xml/xml_file.hpp"

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <filesystem>
#include <sstream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap::robots {
namespace {

constexpr std::uintmax_t kLargestFile = 16U << 20U;  // bytes, as of experiments

std::string readText(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::file_size(path, failure) > kLargestFile && !failure) {
    throw ExperimentError(path + ": is larger than 16 MiB");
  }
  return readBytes(path);
}

/// The first byte that UTF-8 lacks, or of a control character, which YAML refuses; npos of none.
std::size_t findForeignByte(const std::string& text) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  for (auto character = text.begin(); character != text.end();) {
    const auto begin = character;
    const boost::locale::utf::code_point code = Utf8::decode(character, text.end());
    const bool is_control = (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0x7F;
    if (code == boost::locale::utf::illegal || code == boost::locale::utf::incomplete || is_control) {
      return static_cast<std::size_t>(begin - text.begin());
    }
  }
  return std::string::npos;
}

}  // namespace

XmlFile::XmlFile(const std::string& path) : path_(path), text_(readText(path)) {
  for (std::size_t at = text_.find('\n'); at != std::string::npos; at = text_.find('\n', at + 1)) {
    line_ends_.push_back(static_cast<std::ptrdiff_t>(at));
  }
  if (const std::size_t foreign = findForeignByte(text_); foreign != std::string::npos) {
    failAt(path_, calcLine(static_cast<std::ptrdiff_t>(foreign)),
           "has a byte in this line that is not text in UTF-8; save the file as UTF-8");
  }
  const pugi::xml_parse_result result =
      document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    failAt(path_, calcLine(result.offset), std::string("is not XML: ") + result.description());
  }
}

int XmlFile::calcLine(std::ptrdiff_t offset) const {
  return 1 + static_cast<int>(std::lower_bound(line_ends_.begin(), line_ends_.end(), offset) -
                              line_ends_.begin());
}

void XmlFile::fail(const pugi::xml_node& node, const std::string& what) const {
  failAt(path_, getLine(node), std::string("<") + node.name() + ">: " + what);
}

std::string XmlFile::getText(const pugi::xml_node& node, const char* attribute) const {
  const std::string text = node.attribute(attribute).value();
  if (text.empty()) {
    fail(node, std::string("needs the attribute '") + attribute + "'");
  }
  return text;
}

std::vector<double> XmlFile::readNumbers(const pugi::xml_node& node, const char* attribute,
                                         std::size_t count) const {
  std::istringstream text(getText(node, attribute));
  std::vector<double> numbers;
  for (std::string word; text >> word;) {
    double number = 0.0;
    if (!parseLiteral(word[0] == '+' ? word.substr(1) : word, number)) {
      fail(node, std::string("'") + attribute + "' must hold numbers: '" + word + "'");
    }
    numbers.push_back(number);
  }
  if (numbers.size() != count) {
    fail(node, std::string("'") + attribute + "' must hold " + std::to_string(count) +
                   (count == 1 ? " number" : " numbers"));
  }
  return numbers;
}

double XmlFile::getNumber(const pugi::xml_node& node, const char* attribute, const double* fallback) const {
  return fallback != nullptr && !node.attribute(attribute) ? *fallback
                                                           : readNumbers(node, attribute, 1).front();
}

Vector XmlFile::getVector(const pugi::xml_node& node, const char* attribute, const Vector& fallback) const {
  if (!node.attribute(attribute)) {
    return fallback;
  }
  const std::vector<double> numbers = readNumbers(node, attribute, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace twinmap::robots
