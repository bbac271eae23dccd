#include "framework/models/mechanism/load_numbers.hpp"

#include "framework/models/mechanism/element_values.hpp"

namespace twinmap {
namespace {

struct FiniteNumbers {
  ModelNumbers& numbers;
  double calc(const Expression& expression, const std::string& owner, const char* key, const char* unit) {
    return numbers.calc(expression, {owner, key, unit});
  }
  bool knows(const Expression& expression) const {
    return equations::usesOnly(numbers.getValues(), expression);
  }
};

}  // namespace

LoadNumbers calcLoadNumbers(const SystemSpec& spec, const SystemNames& names, ModelNumbers& numbers) {
  const auto [x, y, z] = numbers.calc3(spec.gravity, {"system", "gravity", "m/s2"});
  return {{x, y, z},
          equations::calcElements<double>(spec.elements, names, FiniteNumbers{numbers},
                                          static_cast<int>(spec.states.size()))};
}

}  // namespace twinmap
