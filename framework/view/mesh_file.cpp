#include "framework/view/mesh_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/view/collada_file.hpp"

namespace twinmap::view {
namespace {

using Corner = std::array<double, 3>;

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw std::runtime_error(path + ": " + what);
}

constexpr std::size_t kHeader = 84, kTriangle = 50;  // bytes of a binary STL

/// As many triangles as the header says; a file of text may begin as one.
bool isBinaryStl(const std::string& bytes) {
  if (bytes.size() < kHeader) {
    return false;
  }
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeader - sizeof count, sizeof count);
  return bytes.size() == kHeader + kTriangle * count;
}

Corners readBinaryStl(const std::string& bytes) {
  Corners corners;
  for (std::size_t at = kHeader; at + kTriangle <= bytes.size(); at += kTriangle) {
    std::array<float, 12> numbers{};  // the normal, then three corners
    std::memcpy(numbers.data(), bytes.data() + at, sizeof numbers);
    for (std::size_t i = 3; i < numbers.size(); i += 3) {
      corners.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    }
  }
  return corners;
}

/// The words of a line, the first three numbers of which are a corner.
Corner readCorner(std::istringstream& words, const std::string& path) {
  Corner corner{};
  for (double& number : corner) {
    std::string word;
    if (!(words >> word) || !parseLiteral(word, number)) {
      fail(path, "has a corner that is not three numbers: '" + words.str() + "'");
    }
  }
  return corner;
}

Corners readTextStl(const std::string& text, const std::string& path) {
  Corners corners;
  std::istringstream lines(text);
  for (std::string line, word; std::getline(lines, line);) {
    std::istringstream words(line);
    if (words >> word && word == "vertex") {
      corners.push_back(readCorner(words, path));
    }
  }
  return corners;
}

/// "3", "3/1", "-1//2": a place among the corners so far, from 1, or back from the last.
const Corner& findCorner(const Corners& corners, const std::string& word, const std::string& path) {
  double place = 0.0;
  const double count = static_cast<double>(corners.size());
  const bool is_number = parseLiteral(word.substr(0, word.find('/')), place);
  place = place < 0.0 ? count + place : place - 1.0;
  if (!is_number || !(place >= 0.0 && place < count)) {
    fail(path, "has a face with a corner that does not exist: '" + word + "'");
  }
  return corners[static_cast<std::size_t>(place)];
}

Corners readObj(const std::string& text, const std::string& path) {
  Corners known, corners;
  std::istringstream lines(text);
  for (std::string line, word; std::getline(lines, line);) {
    std::istringstream words(line);
    if (!(words >> word)) {
      continue;
    }
    if (word == "v") {
      known.push_back(readCorner(words, path));
    } else if (word == "f") {
      Corners face;
      while (words >> word) {
        face.push_back(findCorner(known, word, path));
      }
      for (std::size_t i = 2; i < face.size(); ++i) {
        corners.insert(corners.end(), {face[0], face[i - 1], face[i]});
      }
    }
  }
  return corners;
}

std::string getEnding(const std::string& path) {
  const std::size_t point = path.rfind('.');
  std::string ending = point == std::string::npos ? "" : path.substr(point + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return ending;
}

}  // namespace

Corners readMeshFile(const std::string& path) {
  const std::string ending = getEnding(path);
  if (ending != "stl" && ending != "obj" && ending != "dae") {
    fail(path, "is not an STL, OBJ or Collada file (.dae): convert it");
  }
  std::string bytes = readBytes(path);
  if (bytes.size() > kLargestMesh) {
    fail(path, "has more than 100 MB: reduce its triangles");
  }
  Corners corners = ending == "obj"      ? readObj(bytes, path)
                    : ending == "dae"    ? readCollada(std::move(bytes), path)
                    : isBinaryStl(bytes) ? readBinaryStl(bytes)
                                         : readTextStl(bytes, path);
  const auto is_finite = [](const Corner& corner) {
    return std::all_of(corner.begin(), corner.end(), [](double number) { return std::isfinite(number); });
  };
  corners.resize(corners.size() - corners.size() % 3);
  if (corners.empty() || !std::all_of(corners.begin(), corners.end(), is_finite)) {
    fail(path, "has no triangles, or one that is not finite");
  }
  return corners;
}

}  // namespace twinmap::view
