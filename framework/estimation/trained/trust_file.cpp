#include "framework/estimation/trained/trust_file.hpp"

#include <algorithm>
#include <stdexcept>

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

void writeCoverage(Hdf5Writer& file, const std::string& group, const CoverageRecord& record) {
  file.write(group + "/tested", static_cast<double>(record.tested));
  file.write(group + "/share", record.share);
}

CoverageRecord readCoverage(const Hdf5Reader& file, const std::string& group) {
  return {file.readCount(group + "/tested"), file.readVector(group + "/share")};
}

std::vector<ResidualRun> unflatten(const std::vector<std::int64_t>& flat) {
  std::vector<ResidualRun> runs;
  for (std::size_t i = 0; i + 1 < flat.size(); i += 2) {
    runs.push_back({flat[i], flat[i + 1]});
  }
  return runs;
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
  file.writeSamples(group + "/space/whitener", trust.space.whitener);
  file.writeSamples(group + "/space/directions", trust.space.directions);
  file.writeSamples(group + "/space/unmodelled", trust.space.unmodelled);
  file.write(group + "/space/unmodelled_stddev", trust.space.unmodelled_stddev);
  file.write(group + "/runs", flatten(trust.runs));
  file.write(group + "/reference/chi_square", trust.chi_square.sorted);
  file.write(group + "/reference/anomaly", trust.anomaly.sorted);
  file.write(group + "/reference/noise_anomaly", trust.noise_anomaly.sorted);
  file.write(group + "/reference/refinement/tried", static_cast<double>(trust.refinement.tried));
  file.write(group + "/reference/refinement/unexplained", trust.refinement.unexplained);
  writeCoverage(file, group + "/reference/coverage", trust.coverage);
  writeCoverage(file, group + "/reference/refinement/coverage", trust.refined_coverage);
  file.write(group + "/reference/posteriors/ranked", static_cast<double>(trust.posteriors.ranked));
  file.write(group + "/reference/posteriors/p_value", trust.posteriors.p_value);
  file.writeSamples(group + "/cloud/inputs", trust.cloud.inputs);
  file.write(group + "/cloud/scale", trust.cloud.scale);
  file.write(group + "/cloud/reach", trust.cloud.reach);
  file.write(group + "/box/center", trust.center);
  file.write(group + "/box/half_width", trust.half_width);
  file.write(group + "/unknown", static_cast<double>(trust.unknown));
  writePrior(file, group + "/prior", trust.prior);
  file.write(group + "/level", trust.level);
}

TrustModel readTrustModel(const Hdf5Reader& file, const std::string& group,
                          std::shared_ptr<const ForwardSurrogate> of_map) {
  TrustModel trust;
  trust.forward = file.contains(group + "/forward")
                      ? std::make_shared<const ForwardSurrogate>(readForward(file, group + "/forward"))
                      : std::move(of_map);
  trust.space = {file.readSamples(group + "/space/whitener"), file.readSamples(group + "/space/directions"),
                 file.readSamples(group + "/space/unmodelled"),
                 file.readVector(group + "/space/unmodelled_stddev")};
  trust.runs = unflatten(file.readIntegers(group + "/runs"));
  trust.chi_square = {file.readVector(group + "/reference/chi_square")};
  trust.anomaly = {file.readVector(group + "/reference/anomaly")};
  trust.noise_anomaly = {file.readVector(group + "/reference/noise_anomaly")};
  trust.refinement = {file.readCount(group + "/reference/refinement/tried"),
                      file.readVector(group + "/reference/refinement/unexplained")};
  trust.coverage = readCoverage(file, group + "/reference/coverage");
  trust.refined_coverage = readCoverage(file, group + "/reference/refinement/coverage");
  if (const std::string posteriors = group + "/reference/posteriors"; file.contains(posteriors)) {
    trust.posteriors = {file.readCount(posteriors + "/ranked"), file.readVector(posteriors + "/p_value")};
  }
  trust.cloud = {file.readSamples(group + "/cloud/inputs"), file.readVector(group + "/cloud/scale"),
                 file.readNumber(group + "/cloud/reach")};
  trust.center = file.readVector(group + "/box/center");
  trust.half_width = file.readVector(group + "/box/half_width");
  trust.unknown = file.readCount(group + "/unknown");
  trust.level = file.readNumber(group + "/level");
  if (!fitsTogether(trust)) {
    throw std::runtime_error(file.getPath() + ": " + group + " has parts that do not fit each other");
  }
  trust.prior = readPrior(file, group + "/prior", trust.unknown);
  return trust;
}

}  // namespace twinmap
