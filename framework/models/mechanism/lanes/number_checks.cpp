#include "framework/models/mechanism/lanes/number_checks.hpp"

#include <algorithm>
#include <iterator>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

NumberChecks::NumberChecks(ModelContext& context) : context_(context) {
  ModelNumbers& numbers = context.numbers;
  numbers.update(calcBoxCenter(collectSampled(context.model)));
  for (NumberCheck& one : listNumberChecks(context.model)) {
    std::vector<const Expression*> varying;
    const auto used = numbers.listUsed([&] { one.check(context); });
    std::copy_if(used.begin(), used.end(), std::back_inserter(varying),
                 [&](const Expression* expression) { return numbers.varies(*expression); });
    if (!varying.empty()) {
      varying_.push_back({std::move(one), std::move(varying)});
    }
  }
}

void NumberChecks::check(const Eigen::Ref<const Eigen::VectorXd>& point) {
  context_.numbers.update(point);
  for (const VaryingCheck& varying : varying_) {
    if (!varying.all.only_finite || !areFinite(varying)) {
      varying.all.check(context_);
    }
  }
}

bool NumberChecks::areFinite(const VaryingCheck& varying) {
  return std::all_of(varying.expressions.begin(), varying.expressions.end(),
                     [this](const Expression* expression) { return context_.numbers.isFinite(*expression); });
}

}  // namespace twinmap
