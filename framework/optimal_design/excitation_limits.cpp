#include "framework/optimal_design/excitation_limits.hpp"

#include <algorithm>

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

template <class Named>
Index findIndex(const std::vector<Named>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name.text == name; });
  return static_cast<Index>(found - all.begin());
}

void appendLimit(const DesignLimitSpec& spec, const ExperimentSpec& experiment, std::vector<Limit>& limits) {
  if (spec.output) {
    const Index index = findIndex(experiment.model.outputs, spec.output->text);
    limits.push_back({Limit::Kind::output_max_abs, spec.output->text, index, *spec.max_abs, "", spec.where});
    return;
  }
  const Index index = findIndex(experiment.model.excitation, spec.signal->text);
  const std::string& unit = experiment.model.excitation[static_cast<std::size_t>(index)].unit;
  const auto add = [&](Limit::Kind kind, const std::optional<double>& most, const std::string& per) {
    if (most) {
      limits.push_back({kind, spec.signal->text, index, *most, unit + per, spec.where});
    }
  };
  add(Limit::Kind::signal_max_abs, spec.max_abs, "");
  add(Limit::Kind::signal_max_rate, spec.max_rate, "/s");
  add(Limit::Kind::signal_rms, spec.rms, "");
}

}  // namespace

std::string describe(const Limit& limit) {
  switch (limit.kind) {
    case Limit::Kind::signal_max_rate:
      return "largest rate of " + limit.name;
    case Limit::Kind::signal_rms:
      return "rms of " + limit.name;
    default:
      return "largest |" + limit.name + "|";
  }
}

std::vector<Limit> listLimits(const ExperimentSpec& experiment) {
  std::vector<Limit> limits;
  for (const DesignLimitSpec& spec : experiment.design.excitation->limits) {
    appendLimit(spec, experiment, limits);
  }
  return limits;
}

bool limitsOutputs(const std::vector<Limit>& limits) {
  return std::any_of(limits.begin(), limits.end(),
                     [](const Limit& limit) { return limit.kind == Limit::Kind::output_max_abs; });
}

VectorXd calcLargestOutputs(const ResponseLayout& layout, const Eigen::MatrixXd& responses) {
  return VectorXd::NullaryExpr(layout.getOutputCount(), [&](Index output) {
    return responses.middleRows(layout.getRow(output, 0), layout.times.size()).cwiseAbs().maxCoeff();
  });
}

VectorXd measureLimits(const std::vector<Limit>& limits, const std::vector<SignalMeasure>& signals,
                       const VectorXd& largest_outputs) {
  return VectorXd::NullaryExpr(static_cast<Index>(limits.size()), [&](Index i) {
    const Limit& limit = limits[static_cast<std::size_t>(i)];
    if (limit.kind == Limit::Kind::output_max_abs) {
      return largest_outputs[limit.index];
    }
    const SignalMeasure& signal = signals[static_cast<std::size_t>(limit.index)];
    return limit.kind == Limit::Kind::signal_max_abs    ? signal.max_abs
           : limit.kind == Limit::Kind::signal_max_rate ? signal.max_rate
                                                        : signal.rms;
  });
}

}  // namespace twinmap::experiment_design
