#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/labelled_features.hpp"
#include "framework/data/reduction/affine_step.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Indices of the named features. Throws ExperimentError for a name that is none of them, or listed twice.
std::vector<Eigen::Index> selectByName(const FeatureNames& names, const std::vector<FeatureInfo>& infos);

/// Relevance without redundancy (mRMR, difference form; Peng, Long and Ding 2005): each feature in turn has
/// the largest relevance minus mean mutual information with those selected before. Relevance is the sum of
/// the mutual information with each parameter, a lower bound of that with all where parameters are
/// independent, as in a design. On the first noise draw, because the others repeat parameters exactly, which
/// is not a continuous variable. Throws std::invalid_argument for more features than there are. Cost: d (p +
/// count) estimates (calcMutualInformation).
std::vector<Eigen::Index> selectByMutualInformation(const MutualInformationSpec& spec,
                                                    const LabelledFeatures& samples);

/// Greedy D-optimal selection: each feature in turn increases most the sum over the points with sensitivities
/// J of log det(J_S' C_SS^-1 J_S + P), the information of the selected features S in units of the bounds'
/// widths, with noise covariance C and the prior's own information P (empty: 12 1, the box's). Features whose
/// noise is a combination of that of those selected are passed over. Throws std::invalid_argument where no
/// more can be selected, for a feature without noise, and without sensitivities. Cost: count d (count + m
/// p^2) flops for m points.
std::vector<Eigen::Index> selectByFisherInformation(const FisherInformationSpec& spec,
                                                    const NoiseCovariance& noise_covariance,
                                                    const std::vector<Eigen::MatrixXd>& sensitivities,
                                                    const Eigen::MatrixXd& prior = {});

/// What only the list of features shows, before anything is simulated: throws ExperimentError for selected
/// names that are no features, and for a step that asks for more than there can be.
void checkTransformOf(const std::vector<FeatureInfo>& infos, const std::vector<TransformStepSpec>& steps);

/// The step that keeps the selected features, in the order of their selection.
AffineStep fitSelect(const SelectSpec& spec, const LabelledFeatures& samples);

}  // namespace twinmap
