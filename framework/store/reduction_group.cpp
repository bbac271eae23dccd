#include "framework/store/reduction_group.hpp"

#include <stdexcept>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

[[noreturn]] void refuse(const std::string& where) {
  throw std::runtime_error(where + ": the parts of a reduction do not fit each other");
}

}  // namespace

void writeReduction(Hdf5Writer& file, const std::string& group, const ResponseReduction& reduction) {
  const auto windows = static_cast<Index>(reduction.windows.size());
  VectorXd rest(windows), colour(windows), share(windows);
  Eigen::MatrixXf directions(reduction.countSamples(), reduction.countScores());
  Index first = 0;
  for (Index w = 0; w < windows; ++w) {
    const ReductionWindow& window = reduction.windows[static_cast<std::size_t>(w)];
    rest[w] = window.rest_scale;
    colour[w] = window.colour_scale;
    share[w] = window.colour_share;
    directions.middleRows(first, window.directions.rows()) = window.directions;
    first += window.directions.rows();
  }
  file.write(group + "/center", reduction.center);
  file.write(group + "/inverse_stddev", reduction.inverse_stddev);
  file.write(group + "/times", reduction.layout.times);
  file.write(group + "/stddev_ratio", reduction.stddev_ratio);
  file.write(group + "/rest_scale", rest);
  file.write(group + "/colour_scale", colour);
  file.write(group + "/colour_share", share);
  file.writeSingle(group + "/directions", directions);
}

ResponseReduction readReduction(const Hdf5Reader& file, const std::string& group) {
  ResponseReduction reduction;
  reduction.center = file.readVector(group + "/center");
  reduction.inverse_stddev = file.readVector(group + "/inverse_stddev");
  reduction.stddev_ratio = file.readVector(group + "/stddev_ratio");
  const VectorXd times = file.readVector(group + "/times"), rest = file.readVector(group + "/rest_scale"),
                 colour = file.readVector(group + "/colour_scale"),
                 share = file.readVector(group + "/colour_share");
  const Eigen::MatrixXf directions = file.readSamples(group + "/directions").cast<float>();
  if (times.size() < 1 || rest.size() != times.size() || colour.size() != times.size() ||
      share.size() != times.size() || reduction.center.size() != reduction.inverse_stddev.size() ||
      directions.cols() < 1) {
    refuse(file.getPath() + ": " + group);
  }
  reduction.layout = makeReducedLayout(times.size(), directions.cols(), 1.0);
  reduction.layout.times = times;
  // all directions wait in the first window until the rows of each are known
  reduction.windows.resize(static_cast<std::size_t>(times.size()));
  for (Index w = 0; w < times.size(); ++w) {
    reduction.windows[static_cast<std::size_t>(w)].rest_scale = rest[w];
    reduction.windows[static_cast<std::size_t>(w)].colour_scale = colour[w];
    reduction.windows[static_cast<std::size_t>(w)].colour_share = share[w];
  }
  reduction.windows.front().directions = directions;
  return reduction;
}

void placeRows(const ExperimentSpec& experiment, const ResponseLayout& layout, ResponseReduction& reduction) {
  std::vector<ReductionWindow> parts = partResponse(experiment, layout);
  const Eigen::MatrixXf directions = std::move(reduction.windows.front().directions);
  if (parts.size() != reduction.windows.size() || layout.getRowCount() != reduction.center.size()) {
    refuse(experiment.name.text);
  }
  Index first = 0;
  for (std::size_t w = 0; w < parts.size(); ++w) {
    const auto count = static_cast<Index>(parts[w].rows.size());
    if (first + count > directions.rows()) {
      refuse(experiment.name.text);
    }
    reduction.windows[w].rows = std::move(parts[w].rows);
    reduction.windows[w].directions = directions.middleRows(first, count);
    first += count;
  }
  if (first != directions.rows()) {
    refuse(experiment.name.text);
  }
}

}  // namespace twinmap
