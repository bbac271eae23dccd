#include "framework/experiment/tree/write_value.hpp"

namespace twinmap {

YamlNode writeValue(double value) {
  return makeScalar(toText(value));
}
YamlNode writeValue(int value) {
  return makeScalar(std::to_string(value));
}
YamlNode writeValue(bool value) {
  return makeScalar(value ? "true" : "false");
}
YamlNode writeValue(std::uint64_t value) {
  return makeScalar(std::to_string(value));
}
YamlNode writeValue(const std::string& value) {
  return makeScalar(value, true);
}
YamlNode writeValue(const Expression& value) {
  return makeScalar(value.text);
}
YamlNode writeValue(const Name& value) {
  return makeScalar(value.text);
}
YamlNode writeValue(const ComponentCount& value) {
  return value.number ? writeValue(*value.number) : makeScalar("automatic");
}
YamlNode writeValue(const SampleCount& value) {
  return value.automatic ? makeScalar("automatic") : writeValue(value.number);
}
YamlNode writeValue(const Tolerance& value) {
  return value.automatic ? makeScalar("automatic") : writeValue(value.value);
}
YamlNode writeValue(const NoiseStddev& value) {
  return value.unknown ? makeScalar("unknown") : writeValue(value.value);
}
YamlNode writeValue(const Bounds& value) {
  return writeSequence(std::array<double, 2>{value.lower, value.upper});
}
YamlNode writeValue(const ColumnSpec& value) {
  return makeScalar(toText(value));
}

YamlNode writeValue(const ParameterWeights& value) {
  YamlNode map = makeMap();
  for (const ParameterWeight& one : value.values) {
    map.entries.push_back({one.name.text, {}, writeValue(one.weight)});
  }
  return map;
}

YamlNode writeValue(const FreeValues& value) {
  YamlNode map = makeMap();
  for (const FreeValue& one : value.values) {
    YamlNode bounds = writeValue(one.bounds);
    if (one.each) {
      YamlNode each = makeMap();
      each.entries.push_back({"each", {}, std::move(bounds)});
      bounds = std::move(each);
    }
    map.entries.push_back({one.key.text, {}, std::move(bounds)});
  }
  return map;
}

}  // namespace twinmap
