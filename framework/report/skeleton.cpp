#include "framework/report/skeleton.hpp"

#include <cassert>

#include "framework/base/json/json.hpp"
#include "framework/report/assets.hpp"

namespace twinmap {
namespace {

/// By JSON pointer, the slot there.
using Slots = std::map<std::string, std::string>;

/// Texts in place of "{key}"; what they hold is not replaced again.
std::string replaceTexts(const std::string& text, const Texts& texts) {
  std::string replaced;
  std::size_t done = 0;
  for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', open + 1)) {
    const std::size_t close = text.find('}', open);
    const auto found = texts.find(text.substr(open + 1, close - open - 1));
    if (close != std::string::npos && found != texts.end()) {
      replaced += text.substr(done, open - done) + found->second;
      open = close;
      done = close + 1;
    }
  }
  return replaced + text.substr(done);
}

Json replaceTexts(const Json& node, const Texts& texts) {
  if (node.is_string()) {
    return replaceTexts(node.get_ref<const std::string&>(), texts);
  }
  Json replaced = node;
  if (node.is_structured()) {
    for (Json& child : replaced) {
      child = replaceTexts(child, texts);
    }
  }
  return replaced;
}

Slots findSlots(const Panel& panel, const Json& skeleton) {
  const Json& slots = skeleton.at("usermeta").at("slots");
  Slots found;
  for (const auto& [slot, pointers] : slots.items()) {
    for (const auto& pointer : pointers) {
      assert(skeleton.contains(Json::json_pointer(pointer.get<std::string>())));
      found[pointer.get<std::string>()] = slot;
    }
  }
  for (const auto& [slot, value] : panel.values) {
    assert(slots.contains(slot));
  }
  for (const std::string& slot : panel.without) {
    assert(slots.contains(slot));
  }
  return found;
}

/// Fills a skeleton from its root to its leaves.
class Filler {
 public:
  Filler(const Panel& panel, const Json& skeleton) : panel_(panel), slots_(findSlots(panel, skeleton)) {}

  Json fill(const Json& node, const std::string& pointer = "") const {
    if (node.is_array()) {
      return fillArray(node, pointer);
    }
    return node.is_object() ? fillObject(node, pointer) : replaceTexts(node, panel_.texts);
  }

 private:
  Json fillObject(const Json& node, const std::string& pointer) const {
    Json filled = Json::object();
    for (const auto& [key, child] : node.items()) {
      for (Json& part : fillPart(child, pointer + "/" + key)) {
        filled[key] = std::move(part);
      }
    }
    return filled;
  }

  Json fillArray(const Json& node, const std::string& pointer) const {
    Json filled = Json::array();
    for (std::size_t i = 0; i < node.size(); ++i) {
      for (Json& part : fillPart(node[i], pointer + "/" + std::to_string(i))) {
        filled.push_back(std::move(part));
      }
    }
    return filled;
  }

  /// What stands for a part of the skeleton: one value, none, or several.
  std::vector<Json> fillPart(const Json& example, const std::string& pointer) const {
    const auto slot = slots_.find(pointer);
    if (slot == slots_.end()) {
      return {fill(example, pointer)};
    }
    if (panel_.without.count(slot->second) > 0) {
      return {};
    }
    const auto value = panel_.values.find(slot->second);
    if (value == panel_.values.end()) {
      return {fill(example, pointer)};
    }
    if (const auto* repeated = std::get_if<std::vector<Texts>>(&value->second)) {
      return repeat(fill(example, pointer), *repeated);
    }
    return {std::visit([](const auto& given) { return Json(given); }, value->second)};
  }

  static std::vector<Json> repeat(const Json& example, const std::vector<Texts>& each) {
    std::vector<Json> parts;
    for (const Texts& texts : each) {
      parts.push_back(replaceTexts(example, texts));
    }
    return parts;
  }

  const Panel& panel_;
  Slots slots_;
};

const Json& getSkeleton(const std::string& name) {
  static const Json skeletons = parseJson(getFigureSkeletons());
  assert(skeletons.contains(name));
  return skeletons.at(name);
}

}  // namespace

Json makeSpec(const Panel& panel) {
  const Json& skeleton = getSkeleton(panel.skeleton);
  Json shown = skeleton;
  shown.erase("usermeta");
  shown.erase("datasets");
  return Filler(panel, skeleton).fill(shown);
}

std::string describePanel(const Panel& panel) {
  return makeSpec(panel).at("description").get<std::string>();
}

}  // namespace twinmap
