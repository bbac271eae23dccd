#include "framework/base/text/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace twinmap {
namespace {

std::string toLower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Levenshtein distance; O(|a| |b|).
std::size_t calcEditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

/// In any order: 'kye' is 'key'.
bool areSameLetters(std::string a, std::string b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

}  // namespace

std::string suggestName(const std::string& name, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestName = 100;  // a longer one is not a typing error, and would be slow
  if (name.size() > kLongestName) {
    return "";
  }
  std::string best;
  // of a name of one letter, any other letter would be near
  std::size_t smallest = std::min(name.size() / 3 + 2, std::max<std::size_t>(name.size(), 1));
  for (const std::string& candidate : candidates) {
    const std::size_t distance = calcEditDistance(toLower(name), toLower(candidate));
    // half of it stays: 'ok' is not meant by 'foo'
    const bool is_near =
        2 * distance <= std::max(name.size(), candidate.size()) || areSameLetters(name, candidate);
    if (is_near && distance < smallest) {
      smallest = distance;
      best = candidate;
    }
  }
  return best.empty() ? "" : "; did you mean '" + best + "'?";
}

std::string listNames(const std::vector<std::string>& names) {
  std::string listed;
  for (const std::string& name : names) {
    listed += (listed.empty() ? "" : ", ") + name;
  }
  return listed;
}

}  // namespace twinmap
