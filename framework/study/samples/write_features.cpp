#include "framework/study/samples/write_features.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/store/parameters_group.hpp"
#include "framework/study/samples/simulate_missing.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// One of the two sets, and how its noise is drawn.
struct FeatureSet {
  std::string name;
  MatrixXd points;
  RandomStream random;
  int draws;
};

class FeatureSetWriter {
 public:
  FeatureSetWriter(const ExperimentSpec& experiment, const FeatureExtractor& extractor,
                   const SampleSource& source, const RunControl& control, Index block, Hdf5Writer& file)
      : experiment_(experiment),
        extractor_(extractor),
        source_(source),
        control_(control),
        block_(block),
        noise_(experiment.noise, source.simulator.getLayout()),
        file_(file) {}

  void write(const FeatureSet& set) {
    const Index samples = set.points.cols();
    file_.writeSamples("/" + set.name + "/parameters", set.points);
    file_.createSamples("/" + set.name + "/features", set.draws * samples, extractor_.getFeatureCount());
    failed_ = 0;
    std::vector<std::int64_t> ok(static_cast<std::size_t>(samples), 1);
    for (Index first = 0; first < samples; first += block_) {
      writeBlock(set, first, std::min(block_, samples - first), ok);
    }
    requireFew(set);
    file_.write("/" + set.name + "/ok", ok);
  }

 private:
  void writeBlock(const FeatureSet& set, Index first, Index count, std::vector<std::int64_t>& ok) {
    const Trajectories block = simulate(set, first, count);
    for (Index i = 0; i < count; ++i) {
      const SampleStatus& status = block.statuses[static_cast<std::size_t>(i)];
      ok[static_cast<std::size_t>(first + i)] = status.ok ? 1 : 0;
      if (!status.ok && failed_++ == 0) {
        first_failure_ = fmt::format("sample {}: {}", first + i, status.reason);
      }
    }
    for (int draw = 0; draw < set.draws; ++draw) {
      file_.writeSamples("/" + set.name + "/features", draw * set.points.cols() + first,
                         extractor_.extract(noise_.add(block.responses, set.random,
                                                       static_cast<std::uint64_t>(draw), first)));
    }
  }

  Trajectories simulate(const FeatureSet& set, Index first, Index count) {
    MissingOptions options = makeMissingOptions("simulate " + set.name, 1, control_);
    options.allowed_failures = experiment_.model.simulation.allowed_failures;
    if (control_.progress) {
      const int total = static_cast<int>(set.points.cols());
      options.progress = [&, first, total](const SimulationProgress& counts) {
        const int done = static_cast<int>(first) + counts.reused + counts.simulated;
        control_.progress(
            {"simulate " + set.name, done, total, failed_ + counts.failed, double(done) / total, true});
      };
    }
    StoredTrajectories stored =
        simulateMissing(source_.store, source_.simulator, set.points.middleCols(first, count), options);
    if (stored.stopped) {
      throw Interrupted(fmt::format("interrupted: {} of {} {} samples are simulated and kept",
                                    first + stored.counts.reused + stored.counts.simulated, set.points.cols(),
                                    set.name));
    }
    return std::move(stored.trajectories);
  }

  void requireFew(const FeatureSet& set) const {
    const double allowed = experiment_.model.simulation.allowed_failures;
    if (failed_ > allowed * static_cast<double>(set.points.cols())) {
      throw std::runtime_error(fmt::format(
          "{} of {} {} samples failed, more than simulation.allowed_failures = {} permits; the first is {}",
          failed_, set.points.cols(), set.name, allowed, first_failure_));
    }
  }

  const ExperimentSpec& experiment_;
  const FeatureExtractor& extractor_;
  const SampleSource& source_;
  const RunControl& control_;
  Index block_;
  ResponseNoise noise_;
  Hdf5Writer& file_;
  int failed_ = 0;  // of the set under way
  std::string first_failure_;
};

void writeFeatureInfos(Hdf5Writer& file, const std::vector<FeatureInfo>& infos) {
  std::vector<std::string> names, units;
  for (const FeatureInfo& info : infos) {
    names.push_back(info.name);
    units.push_back(info.unit);
  }
  file.write("/features/name", names);
  file.write("/features/unit", units);
}

}  // namespace

void writeFeatures(const std::filesystem::path& path, const ExperimentSpec& experiment,
                   const FeatureExtractor& extractor, const SampleSource& source, const RunControl& control,
                   Index block) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary);
    file.writeAttribute("/", "format", "twinmap features 1");
    file.write("/experiment", std::vector<std::string>{writeExperiment(experiment)});
    writeParametersGroup(file, "/parameters", collectSampled(experiment.model));
    writeFeatureInfos(file, extractor.getInfos());
    FeatureSetWriter writer(experiment, extractor, source, control, block, file);
    writer.write({"train",
                  sampleTrainPoints(experiment),
                  {experiment.seed, RandomPurpose::kTrainNoise},
                  experiment.noise.replicates.value_or(1)});
    writer.write({"test", sampleTestPoints(experiment), {experiment.seed, RandomPurpose::kTestNoise}, 1});
    file.close();
  });
}

}  // namespace twinmap
