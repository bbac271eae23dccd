#include "framework/estimation/trained/trust_file.hpp"

#include <algorithm>

#include "framework/base/hdf5/hdf5_fields.hpp"
#include "framework/estimation/surrogate/surrogate_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

std::vector<std::int64_t> flatten(const std::vector<ResidualRun>& runs) {
  std::vector<std::int64_t> flat;
  for (const ResidualRun& run : runs) {
    flat.push_back(run.first);
    flat.push_back(run.count);
  }
  return flat;
}

std::vector<ResidualRun> unflatten(const std::vector<std::int64_t>& flat) {
  std::vector<ResidualRun> runs;
  for (std::size_t i = 0; i + 1 < flat.size(); i += 2) {
    runs.push_back({flat[i], flat[i + 1]});
  }
  return runs;
}

template <class Fields, class Record>
void listCoverage(const Fields& fields, Record& record) {
  fields("tested", record.tested);
  fields("share", record.share);
}

template <class Fields, class Trust>
void listTrust(const Fields& fields, Trust& trust) {
  fields("space/whitener", trust.space.whitener);
  fields("space/directions", trust.space.directions);
  fields("space/unmodelled", trust.space.unmodelled);
  fields("space/unmodelled_stddev", trust.space.unmodelled_stddev);
  fields.converted("runs", trust.runs, flatten, unflatten);
  fields("reference/chi_square", trust.chi_square.sorted);
  fields("reference/anomaly", trust.anomaly.sorted);
  fields("reference/noise_anomaly", trust.noise_anomaly.sorted);
  fields("reference/refinement/tried", trust.refinement.tried);
  fields("reference/refinement/unexplained", trust.refinement.unexplained);
  listCoverage(fields.in("reference/coverage"), trust.coverage);
  listCoverage(fields.in("reference/refinement/coverage"), trust.refined_coverage);
  if (fields.has("reference/posteriors", true)) {
    fields("reference/posteriors/ranked", trust.posteriors.ranked);
    fields("reference/posteriors/p_value", trust.posteriors.p_value);
  }
  fields("cloud/inputs", trust.cloud.inputs);
  fields("cloud/scale", trust.cloud.scale);
  fields("cloud/reach", trust.cloud.reach);
  fields("box/center", trust.center);
  fields("box/half_width", trust.half_width);
  fields("unknown", trust.unknown);
}

bool liesWithin(const std::vector<ResidualRun>& runs, Index residuals) {
  return std::all_of(runs.begin(), runs.end(), [&](const ResidualRun& run) {
    return run.first >= 0 && run.count > 0 && run.count <= residuals && run.first <= residuals - run.count;
  });
}

bool fitsTogether(const TrustModel& trust) {
  if (trust.forward == nullptr) {
    return false;
  }
  const ResidualSpace& space = trust.space;
  const Index residuals = space.directions.rows(), variables = trust.forward->points.rows();
  const Index features = trust.forward->center.size();
  const bool whitens =
      space.whitener.rows() == residuals &&
      (space.whitener.cols() == features || (space.whitener.cols() == 1 && residuals == features));
  return whitens && residuals > 0 && space.directions.cols() == trust.forward->getScoreCount() &&
         space.unmodelled.rows() == residuals && space.unmodelled.cols() == space.unmodelled_stddev.size() &&
         liesWithin(trust.runs, residuals) && trust.chi_square.sorted.size() > 0 &&
         trust.anomaly.sorted.size() > 0 && trust.noise_anomaly.sorted.size() > 0 &&
         trust.cloud.inputs.size() > 0 && trust.cloud.scale.size() == trust.cloud.inputs.rows() &&
         trust.center.size() == variables && trust.half_width.size() == variables && trust.unknown > 0 &&
         trust.unknown <= variables;
}

}  // namespace

void writeTrustModel(Hdf5Writer& file, const std::string& group, const TrustModel& trust,
                     const ForwardSurrogate* of_map) {
  if (trust.forward.get() != of_map) {
    writeForward(file, group + "/forward", *trust.forward);
  }
  const WrittenFields fields(file, group);
  listTrust(fields, trust);
  writePrior(file, group + "/prior", trust.prior);
  fields("level", trust.level);
}

TrustModel readTrustModel(const Hdf5Reader& file, const std::string& group,
                          std::shared_ptr<const ForwardSurrogate> of_map) {
  TrustModel trust;
  trust.forward = file.contains(group + "/forward")
                      ? std::make_shared<const ForwardSurrogate>(readForward(file, group + "/forward"))
                      : std::move(of_map);
  const ReadFields fields(file, group);
  listTrust(fields, trust);
  fields("level", trust.level);
  fields.require(fitsTogether(trust));
  trust.prior = readPrior(file, group + "/prior", trust.unknown);
  return trust;
}

}  // namespace twinmap
