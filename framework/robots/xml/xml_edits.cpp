#include "framework/robots/xml/xml_edits.hpp"

#include <algorithm>
#include <utility>

#include "framework/base/text/number_text.hpp"

namespace twinmap::robots {
namespace {

constexpr const char* kSpaces = " \t\r\n";

bool differ(const std::vector<double>& a, const std::vector<double>& b) {
  return !std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

std::string joinNumbers(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) {
    text += (text.empty() ? "" : " ") + toText(number);
  }
  return text;
}

void XmlEdits::setNumbers(const pugi::xml_node& node, const char* attribute, const std::vector<double>& old,
                          const std::vector<double>& numbers) {
  if (!differ(old, numbers)) {
    return;
  }
  const Span tag = findStartTag(node);
  Span value{};
  if (findValue(tag, attribute, value)) {
    setWords(value, old, numbers);
    return;
  }
  const std::size_t name_end = file_.getText().find_first_of(std::string(kSpaces) + "/>", tag.begin);
  edits_.push_back({name_end, 0, " " + std::string(attribute) + "=\"" + joinNumbers(numbers) + "\""});
}

void XmlEdits::removeAttribute(const pugi::xml_node& node, const char* attribute) {
  Span value{};
  if (!findValue(findStartTag(node), attribute, value)) {
    return;
  }
  const std::string& text = file_.getText();
  const std::size_t equals = text.rfind('=', value.begin);
  const std::size_t name_end = text.find_last_not_of(kSpaces, equals - 1);
  const std::size_t before = text.find_last_of(kSpaces, name_end);
  const std::size_t begin = text.find_last_not_of(kSpaces, before) + 1;
  edits_.push_back({begin, value.end + 1 - begin, ""});
}

void XmlEdits::setWords(const Span& value, const std::vector<double>& old,
                        const std::vector<double>& numbers) {
  const std::string& text = file_.getText();
  std::size_t at = value.begin;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    at = text.find_first_not_of(kSpaces, at);
    const std::size_t end = std::min(text.find_first_of(kSpaces, at), value.end);
    if (old[i] != numbers[i]) {
      edits_.push_back({at, end - at, toText(numbers[i])});
    }
    at = end;
  }
}

void XmlEdits::addElement(const pugi::xml_node& parent, const std::string& text) {
  const std::string& file = file_.getText();
  const std::size_t after = findStartTag(parent).end + 1;
  const std::size_t next = std::min(file.find('<', after), file.size());
  const std::string space = file.substr(after, next - after);
  const bool is_space = space.find_first_not_of(kSpaces) == std::string::npos;
  edits_.push_back({after, 0, (is_space ? space : "") + text});
}

/// From the element's name to its '>', outside of quotes.
XmlEdits::Span XmlEdits::findStartTag(const pugi::xml_node& node) const {
  const std::string& text = file_.getText();
  const auto begin = static_cast<std::size_t>(node.offset_debug());
  char quote = 0;
  std::size_t at = begin;
  for (; at < text.size() && (quote != 0 || text[at] != '>'); ++at) {
    if (quote != 0) {
      quote = text[at] == quote ? '\0' : quote;
    } else if (text[at] == '"' || text[at] == '\'') {
      quote = text[at];
    }
  }
  return {begin, at};
}

bool XmlEdits::findValue(const Span& tag, const std::string& attribute, Span& value) const {
  const std::string& text = file_.getText();
  std::size_t at = text.find_first_of(kSpaces, tag.begin);
  while (at < tag.end) {
    const std::size_t name = text.find_first_not_of(kSpaces, at);
    const std::size_t equals = text.find('=', name);
    if (name >= tag.end || equals >= tag.end) {
      return false;
    }
    const std::size_t open = text.find_first_of("\"'", equals);
    const std::size_t close = text.find(text[open], open + 1);
    const std::size_t name_end = std::min(text.find_first_of(kSpaces, name), equals);
    if (text.compare(name, name_end - name, attribute) == 0) {
      value = {open + 1, close};
      return true;
    }
    at = close + 1;
  }
  return false;
}

std::string XmlEdits::apply() const {
  std::vector<Edit> edits = edits_;
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) {
    return std::pair(a.begin, a.length) < std::pair(b.begin, b.length);
  });
  const std::string& text = file_.getText();
  std::string changed;
  std::size_t done = 0;
  for (const Edit& edit : edits) {
    changed.append(text, done, edit.begin - done).append(edit.text);
    done = edit.begin + edit.length;
  }
  return changed.append(text, done, std::string::npos);
}

}  // namespace twinmap::robots
