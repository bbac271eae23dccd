#include "framework/store/trained_file.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/hdf5/hdf5_fields.hpp"
#include "framework/estimation/estimator.hpp"
#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"
#include "framework/estimation/surrogate/surrogate_file.hpp"
#include "framework/estimation/trained/trust_model.hpp"
#include "framework/store/parameters_group.hpp"
#include "framework/store/reduction_group.hpp"

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

/// Writes a trust model below `group` (docs/reference/files.md); its surrogate only where that is not the
/// map's own (`of_map`; may be null).
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

/// Reads it back. Throws std::runtime_error or std::invalid_argument for parts that are missing or do not fit
/// each other.
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

struct EstimatorKind {
  const char* name;
  std::shared_ptr<const Estimator> (*load)(const Hdf5Reader& file, const std::string& group);
};

constexpr EstimatorKind kKinds[] = {
    {"gp", loadProcesses}, {"surrogate", loadSurrogate}, {"network", loadNetwork}};

/// Reads a trained estimator of a kind (Estimator::getKind()) from `group` of maps.h5; it infers bit for bit
/// as the one that was saved. Throws std::runtime_error for a kind that nobody knows, and for parts that are
/// missing or do not fit each other.
std::shared_ptr<const Estimator> loadEstimator(const std::string& kind, const Hdf5Reader& file,
                                               const std::string& group) {
  for (const EstimatorKind& known : kKinds) {
    if (kind == known.name) {
      return known.load(file, group);
    }
  }
  throw std::runtime_error(file.getPath() + ": unknown kind of map '" + kind + "'");
}

constexpr const char* kFormat = "twinmap maps 4";
constexpr const char* kParameters = "/parameters";
constexpr const char* kInputs = "/inputs";
constexpr const char* kFeatures = "/features/name";
constexpr const char* kExperiment = "/experiment";
constexpr const char* kMap = "/map";
constexpr const char* kTrust = "/trust";
constexpr const char* kSharedError = "/shared_error";
constexpr const char* kReduction = "/reduction";

}  // namespace

void writeTrainedFile(const std::filesystem::path& path, const TrainedFile& stored) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary, Hdf5Seal::kDigest);
    file.writeAttribute("/", "format", kFormat);
    writeParametersGroup(file, kParameters, stored.parameters);
    writeParametersGroup(file, kInputs, stored.inputs);
    file.write(kFeatures, stored.feature_names);
    const Estimator& map = *stored.model.map;
    map.save(file, kMap);
    file.writeAttribute(kMap, "kind", map.getKind());
    if (stored.model.trust) {
      writeTrustModel(file, kTrust, *stored.model.trust, map.findForward().get());
    }
    if (stored.model.shared_error.size() > 0) {
      file.write(kSharedError, stored.model.shared_error);
    }
    if (stored.reduction) {
      writeReduction(file, kReduction, *stored.reduction);
    }
    file.write(kExperiment, std::vector<std::string>{stored.experiment});
    file.close();
  });
}

TrainedFile readTrainedFile(const std::filesystem::path& path, Hdf5Seal seal) {
  const Hdf5Reader file(path, seal);
  if (file.readAttribute("/", "format") != kFormat) {
    throw std::runtime_error(path.string() + ": is not a maps.h5 of this version of twinmap");
  }
  TrainedFile stored;
  stored.parameters = readParametersGroup(file, kParameters);
  stored.inputs = readParametersGroup(file, kInputs);
  stored.feature_names = file.readTexts(kFeatures);
  stored.model.map = loadEstimator(file.readAttribute(kMap, "kind"), file, kMap);
  if (file.contains(kTrust)) {
    stored.model.trust = readTrustModel(file, kTrust, stored.model.map->findForward());
    if (stored.model.trust->unknown < stored.model.map->getResidualCorrelation().rows()) {
      throw std::runtime_error(path.string() + ": " + kTrust + " has fewer parameters than " + kMap);
    }
  }
  if (file.contains(kSharedError)) {
    stored.model.shared_error = file.readVector(kSharedError);
    if (stored.model.shared_error.size() != static_cast<Index>(stored.parameters.size())) {
      throw std::runtime_error(path.string() + ": " + kSharedError +
                               " must have a number for each parameter");
    }
  }
  if (file.contains(std::string(kReduction) + "/center")) {
    stored.reduction = std::make_shared<const ResponseReduction>(readReduction(file, kReduction));
  }
  const std::vector<std::string> experiment = file.readTexts(kExperiment);
  if (experiment.size() != 1) {
    throw std::runtime_error(path.string() + ": must hold one experiment");
  }
  stored.experiment = experiment.front();
  return stored;
}

}  // namespace twinmap
