#include "framework/data/reduction/selections.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "framework/data/reduction/mutual_information.hpp"
#include "framework/experiment/check/known_names.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void requireEnough(Index asked, Index features) {
  if (asked > features) {
    throw std::invalid_argument(fmt::format("select: asked for {} of {} features", asked, features));
  }
}

std::vector<RankedValues> rankRows(const MatrixXd& rows) {
  std::vector<RankedValues> ranked;
  for (Index i = 0; i < rows.rows(); ++i) {
    ranked.push_back(rankValues(rows.row(i)));
  }
  return ranked;
}

VectorXd calcRelevance(const std::vector<RankedValues>& features, const std::vector<RankedValues>& parameters,
                       int neighbours) {
  VectorXd relevance = VectorXd::Zero(static_cast<Index>(features.size()));
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (const RankedValues& parameter : parameters) {
      relevance[static_cast<Index>(i)] += calcMutualInformation(features[i], parameter, neighbours);
    }
  }
  return relevance;
}

/// The one with the largest score that is not taken, the first of equals.
Index findBest(const VectorXd& scores, const std::vector<Index>& taken) {
  Index best = -1;
  for (Index i = 0; i < scores.size(); ++i) {
    const bool free = std::find(taken.begin(), taken.end(), i) == taken.end();
    if (free && (best < 0 || scores[i] > scores[best])) {
      best = i;
    }
  }
  return best;
}

}  // namespace

std::vector<Index> selectByName(const FeatureNames& names, const std::vector<FeatureInfo>& infos) {
  std::vector<std::string> known;
  for (const FeatureInfo& info : infos) {
    known.push_back(info.name);
  }
  std::vector<Index> selected;
  for (const Name& name : names) {
    requireKnown(name, known, "a feature");
    selected.push_back(std::find(known.begin(), known.end(), name.text) - known.begin());
    if (std::count(selected.begin(), selected.end(), selected.back()) > 1) {
      throw ExperimentError(name.where, name.text, "is listed twice");
    }
  }
  return selected;
}

std::vector<Index> selectByMutualInformation(const MutualInformationSpec& spec,
                                             const LabelledFeatures& samples) {
  requireEnough(spec.count, samples.features.rows());
  const Index simulations = samples.features.cols() / samples.replicates;
  const int neighbours = static_cast<int>(std::min<Index>(spec.neighbours, simulations - 1));
  const std::vector<RankedValues> features = rankRows(samples.features.leftCols(simulations));
  const std::vector<RankedValues> parameters = rankRows(samples.parameters.leftCols(simulations));
  const VectorXd relevance = calcRelevance(features, parameters, neighbours);
  VectorXd redundancy = VectorXd::Zero(relevance.size());
  std::vector<Index> selected{findBest(relevance, {})};
  while (static_cast<int>(selected.size()) < spec.count) {
    for (Index i = 0; i < redundancy.size(); ++i) {
      redundancy[i] += calcMutualInformation(features[i], features[selected.back()], neighbours);
    }
    selected.push_back(findBest(relevance - redundancy / static_cast<double>(selected.size()), selected));
  }
  return selected;
}

namespace {

std::vector<Index> selectBy(const FeatureNames& names, const LabelledFeatures& samples) {
  return selectByName(names, samples.infos);
}
std::vector<Index> selectBy(const MutualInformationSpec& spec, const LabelledFeatures& samples) {
  return selectByMutualInformation(spec, samples);
}
std::vector<Index> selectBy(const FisherInformationSpec& spec, const LabelledFeatures& samples) {
  return selectByFisherInformation(spec, samples.noise_covariance, samples.sensitivities,
                                   samples.prior_information);
}

}  // namespace

AffineStep fitSelect(const SelectSpec& spec, const LabelledFeatures& samples) {
  const std::vector<Index> selected =
      std::visit([&samples](const auto& by) { return selectBy(by, samples); }, spec);
  return makeSelection(selected, samples.features.rows());
}

}  // namespace twinmap
