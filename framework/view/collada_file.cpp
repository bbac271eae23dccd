#include "framework/view/collada_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <stdexcept>
#include <vector>

#include "framework/view/scene.hpp"

namespace twinmap::view {
namespace {

using Node = pugi::xml_node;

class ColladaReader {
 public:
  ColladaReader(std::string bytes, const std::string& path) : path_(path), bytes_(std::move(bytes)) {
    const auto result = document_.load_buffer_inplace(bytes_.data(), bytes_.size());
    if (!result) {
      fail(std::string("is not XML: ") + result.description());
    }
    if (!document_.child("COLLADA")) {
      fail("is not a Collada file: it has no <COLLADA>");
    }
  }

  Corners read() {
    Identifiers identifiers(places_);
    document_.traverse(identifiers);
    const Node collada = document_.child("COLLADA");
    const double metre = collada.child("asset").child("unit").attribute("meter").as_double(1.0);
    const Node instance = collada.child("scene").child("instance_visual_scene");
    const Node scene =
        instance ? follow(instance, "url") : collada.child("library_visual_scenes").child("visual_scene");
    addNodes(scene, {algebra::makeDiagonal(metre), {}}, 0);
    return std::move(corners_);
  }

 private:
  /// All elements that can be pointed at.
  struct Identifiers : pugi::xml_tree_walker {
    explicit Identifiers(std::map<std::string, Node>& all) : places(all) {}
    bool for_each(Node& node) override {
      if (const pugi::xml_attribute id = node.attribute("id")) {
        places.emplace(id.value(), node);
      }
      return true;
    }
    std::map<std::string, Node>& places;
  };

  /// Of a primitive: which of its numbers are places of corners, and the points there.
  struct Layout {
    std::size_t offset = 0, stride = 1;
    const std::vector<Vector>* points = nullptr;
  };

  [[noreturn]] void fail(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }

  Node follow(const Node& node, const char* attribute) const {
    const std::string reference = node.attribute(attribute).value();
    const auto found = places_.find(reference.substr(std::min<std::size_t>(reference.size(), 1)));
    if (reference.empty() || reference.front() != '#' || found == places_.end()) {
      fail(std::string("has a <") + node.name() + "> that points at nothing in the file: '" + reference +
           "'");
    }
    return found->second;
  }

  template <class Number>
  std::vector<Number> readNumbers(const Node& node) const {
    std::vector<Number> numbers;
    const char* at = node.child_value();
    const char* const end = at + std::char_traits<char>::length(at);
    const auto is_space = [](char letter) { return letter == ' ' || (letter >= '\t' && letter <= '\r'); };
    for (at = std::find_if_not(at, end, is_space); at != end; at = std::find_if_not(at, end, is_space)) {
      at += *at == '+' ? 1 : 0;
      Number number{};
      const auto [next, error] = std::from_chars(at, end, number);
      if (error != std::errc() || (next != end && !is_space(*next))) {
        fail(std::string("<") + node.name() + "> has what is not a number: '" +
             std::string(at, std::find_if(at, end, is_space)) + "'");
      }
      numbers.push_back(number);
      at = next;
    }
    return numbers;
  }

  std::vector<double> readNumbers(const Node& node, std::size_t count) const {
    std::vector<double> numbers = readNumbers<double>(node);
    if (numbers.size() != count) {
      fail(std::string("<") + node.name() + "> must have " + std::to_string(count) + " numbers");
    }
    return numbers;
  }

  /// Of an element that transforms; false of another.
  bool readTransform(const Node& node, Pose& transform) const {
    const std::string kind = node.name();
    if (kind == "matrix") {  // row by row
      const std::vector<double> m = readNumbers(node, 16);
      transform = {{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}, {m[3], m[7], m[11]}};
    } else if (kind == "translate") {
      const std::vector<double> v = readNumbers(node, 3);
      transform.origin = {v[0], v[1], v[2]};
    } else if (kind == "scale") {
      const std::vector<double> v = readNumbers(node, 3);
      transform.rotation = {{v[0], 0.0, 0.0}, {0.0, v[1], 0.0}, {0.0, 0.0, v[2]}};
    } else if (kind == "rotate") {  // about an axis, in degrees
      const std::vector<double> v = readNumbers(node, 4);
      const double length = std::hypot(v[0], v[1], v[2]);
      if (length > 0.0) {
        const Vector axis{v[0] / length, v[1] / length, v[2] / length};
        transform.rotation = algebra::rotateAbout(axis, v[3] * std::acos(-1.0) / 180.0);
      }
    } else if (kind == "skew" || kind == "lookat") {
      fail("<" + kind + "> is not read: apply it to the mesh, or convert the file to STL");
    } else {
      return false;
    }
    return true;
  }

  /// What stands in a scene or a node.
  void addNodes(const Node& parent, Pose frame, int depth) {
    constexpr int kDeepest = 100;  // nodes within nodes, more than any scene has; of a circle there is no end
    if (depth > kDeepest) {
      fail("has nodes within nodes without end");
    }
    for (const Node& child : parent.children()) {
      const std::string kind = child.name();
      Pose transform;
      if (readTransform(child, transform)) {
        frame = frame * transform;
      } else if (kind == "node") {
        addNodes(child, frame, depth + 1);
      } else if (kind == "instance_node") {
        count();
        addNodes(follow(child, "url"), frame, depth + 1);
      } else if (kind == "instance_geometry") {
        addGeometry(follow(child, "url"), frame);
      } else if (kind == "instance_controller") {
        addGeometry(follow(follow(child, "url").child("skin"), "source"), frame);
      }
    }
  }

  /// Each time that something is drawn again, which few bytes can ask for without end.
  void count() {
    constexpr std::size_t kMost = kLargestMesh / 50;  // triangles of the largest binary STL
    if (++drawn_ > kMost) {
      fail("draws more than " + std::to_string(kMost) + " triangles: reduce them");
    }
  }

  void addGeometry(const Node& geometry, const Pose& frame) {
    count();
    for (const Node& primitive : geometry.child("mesh").children()) {
      const std::string kind = primitive.name();
      const bool is_strip = kind == "tristrips";
      if (kind == "triangles" || kind == "polylist" || kind == "polygons" || is_strip || kind == "trifans") {
        const Layout layout = readLayout(primitive);
        const std::vector<std::size_t> counts =
            readNumbers<std::size_t>(kind == "polylist" ? primitive.child("vcount") : Node());
        for (const Node& places : primitive.children("p")) {
          addPolygons(kind, listCorners(layout, readNumbers<std::size_t>(places)), counts, frame);
        }
        for (const Node& holed : primitive.children("ph")) {
          addFan(listCorners(layout, readNumbers<std::size_t>(holed.child("p"))), frame);
        }
      }
    }
  }

  void addPolygons(const std::string& kind, const std::vector<Vector>& corners,
                   const std::vector<std::size_t>& counts, const Pose& frame) {
    if (kind == "polygons" || kind == "trifans") {
      addFan(corners, frame);
    } else if (kind == "tristrips") {
      for (std::size_t i = 2; i < corners.size(); ++i) {
        addTriangle(corners[i - 2 + i % 2], corners[i - 1 - i % 2], corners[i], frame);
      }
    } else if (kind == "triangles") {
      for (std::size_t i = 2; i < corners.size(); i += 3) {
        addTriangle(corners[i - 2], corners[i - 1], corners[i], frame);
      }
    } else {
      std::size_t first = 0;
      for (const std::size_t count : counts) {
        if (count > corners.size() - first) {
          fail("<polylist> has fewer corners than <vcount> says");
        }
        addFan({corners.begin() + static_cast<std::ptrdiff_t>(first),
                corners.begin() + static_cast<std::ptrdiff_t>(first + count)},
               frame);
        first += count;
      }
    }
  }

  Layout readLayout(const Node& primitive) {
    Layout layout;
    for (const Node& input : primitive.children("input")) {
      const std::size_t offset = input.attribute("offset").as_uint();
      layout.stride = std::max(layout.stride, offset + 1);
      if (std::string(input.attribute("semantic").value()) == "VERTEX") {
        const Node vertices = follow(input, "source");
        layout.offset = offset;
        layout.points =
            &getPoints(follow(vertices.find_child_by_attribute("input", "semantic", "POSITION"), "source"));
      }
    }
    if (layout.points == nullptr) {
      fail(std::string("<") + primitive.name() + "> has no VERTEX");
    }
    return layout;
  }

  /// Of a <source>, read once.
  const std::vector<Vector>& getPoints(const Node& source) {
    const auto [place, is_new] = points_.try_emplace(source.attribute("id").value());
    if (is_new) {
      const Node accessor = source.child("technique_common").child("accessor");
      const std::size_t stride = accessor.attribute("stride").as_uint(3);
      const std::vector<double> numbers = readNumbers<double>(source.child("float_array"));
      for (std::size_t i = accessor.attribute("offset").as_uint(); stride >= 3 && i + 3 <= numbers.size();
           i += stride) {
        place->second.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
      }
    }
    return place->second;
  }

  std::vector<Vector> listCorners(const Layout& layout, const std::vector<std::size_t>& places) const {
    std::vector<Vector> corners;
    for (std::size_t i = layout.offset; i < places.size(); i += layout.stride) {
      if (places[i] >= layout.points->size()) {
        fail("has a face with a corner that does not exist: " + std::to_string(places[i]));
      }
      corners.push_back((*layout.points)[places[i]]);
    }
    return corners;
  }

  void addFan(const std::vector<Vector>& corners, const Pose& frame) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      addTriangle(corners[0], corners[i - 1], corners[i], frame);
    }
  }

  void addTriangle(const Vector& a, const Vector& b, const Vector& c, const Pose& frame) {
    count();
    const auto& m = frame.rotation;
    const bool is_mirrored = algebra::dot(algebra::cross(m.x, m.y), m.z) < 0.0;
    for (const Vector* corner : {&a, is_mirrored ? &c : &b, is_mirrored ? &b : &c}) {
      const Vector at = m * *corner + frame.origin;
      corners_.push_back({at.x, at.y, at.z});
    }
  }

  const std::string& path_;
  std::string bytes_;
  pugi::xml_document document_;
  std::map<std::string, Node> places_;
  std::map<std::string, std::vector<Vector>> points_;  ///< by the source
  std::size_t drawn_ = 0;
  Corners corners_;
};

}  // namespace

Corners readCollada(std::string bytes, const std::string& path) {
  return ColladaReader(std::move(bytes), path).read();
}

}  // namespace twinmap::view
