#include "framework/estimation/surrogate/surrogate_file.hpp"

#include <stdexcept>
#include <vector>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* kSquaredExponential = "squared_exponential";
constexpr const char* kMatern52 = "matern52";
constexpr const char* kLinear = "linear";
constexpr const char* kQuadratic = "quadratic";

gp::SmoothCovariance parseCovariance(const std::string& text) {
  if (text != kSquaredExponential && text != kMatern52) {
    throw std::runtime_error("a surrogate has an unknown '" + text + "'");
  }
  return text == kMatern52 ? gp::SmoothCovariance::kMatern52 : gp::SmoothCovariance::kSquaredExponential;
}

gp::Trend parseTrend(const std::string& text) {
  if (text != kLinear && text != kQuadratic) {
    throw std::runtime_error("a surrogate has an unknown '" + text + "'");
  }
  return text == kQuadratic ? gp::Trend::kQuadratic : gp::Trend::kLinear;
}

/// The numbers of one kind of all windows, one after the other.
class Flat {
 public:
  Flat() = default;
  explicit Flat(VectorXd numbers) : numbers_(std::move(numbers)) {}

  void append(const MatrixXd& part) {
    const Index before = numbers_.size();
    numbers_.conservativeResize(before + part.size());
    numbers_.tail(part.size()) = Eigen::Map<const VectorXd>(part.data(), part.size());
  }

  /// The next ones, column by column.
  MatrixXd take(Index rows, Index cols) {
    const Index left = numbers_.size() - taken_;
    if (rows < 0 || cols < 0 || (rows > 0 && cols > left / rows)) {
      throw std::invalid_argument("a surrogate's numbers are too few");
    }
    const MatrixXd part = Eigen::Map<const MatrixXd>(numbers_.data() + taken_, rows, cols);
    taken_ += rows * cols;
    return part;
  }

  const VectorXd& getNumbers() const { return numbers_; }

 private:
  VectorXd numbers_;
  Index taken_ = 0;
};

/// What differs in size or kind from window to window.
struct WindowTable {
  std::vector<std::string> covariances, trends;
  std::vector<std::int64_t> functions, slope_points, slope_variables;
  VectorXd nuggets;
};

/// The numbers of all windows.
struct WindowNumbers {
  Flat length_scales, scaled_points, weights, coefficients, factor_tiles, solved_terms, term_factors,
      amplitudes, left_out_ratios;
};

/// Calls action(name, numbers) for each kind.
template <class Numbers, class Action>
void forEachKind(Numbers& numbers, const Action& action) {
  action("length_scales", numbers.length_scales);
  action("scaled_points", numbers.scaled_points);
  action("weights", numbers.weights);
  action("coefficients", numbers.coefficients);
  action("factor_tiles", numbers.factor_tiles);
  action("solved_terms", numbers.solved_terms);
  action("term_factors", numbers.term_factors);
  action("amplitudes", numbers.amplitudes);
  action("left_out_ratios", numbers.left_out_ratios);
}

void appendProcess(const gp::SharedProcessParts& parts, WindowTable& table, WindowNumbers& numbers) {
  const bool matern = parts.structure.covariance == gp::SmoothCovariance::kMatern52;
  table.covariances.emplace_back(matern ? kMatern52 : kSquaredExponential);
  table.trends.emplace_back(parts.structure.trend == gp::Trend::kQuadratic ? kQuadratic : kLinear);
  table.functions.push_back(parts.weights.cols());
  table.slope_points.push_back(parts.slope_points);
  table.slope_variables.push_back(parts.slope_variables);
  numbers.length_scales.append(parts.hyperparameters.length_scales);
  numbers.scaled_points.append(parts.scaled_points);
  numbers.weights.append(parts.weights);
  numbers.coefficients.append(parts.coefficients);
  numbers.factor_tiles.append(parts.factor_tiles);
  numbers.solved_terms.append(parts.solved_terms);
  numbers.term_factors.append(parts.term_factor);
  numbers.amplitudes.append(parts.amplitude);
  numbers.left_out_ratios.append(parts.left_out_ratio);
}

bool describesEachWindow(const WindowTable& table) {
  const std::size_t windows = table.functions.size();
  return table.covariances.size() == windows && table.trends.size() == windows &&
         table.slope_points.size() == windows && table.slope_variables.size() == windows &&
         table.nuggets.size() == static_cast<Index>(windows);
}

/// The next window of p variables and n points.
gp::SharedProcessParts take(const WindowTable& table, std::size_t window, Index p, Index n,
                            WindowNumbers& numbers) {
  gp::SharedProcessParts parts;
  parts.structure = {parseCovariance(table.covariances.at(window)), parseTrend(table.trends.at(window))};
  parts.slope_points = table.slope_points.at(window);
  parts.slope_variables = table.slope_variables.at(window);
  parts.structure.slopes = parts.slope_points > 0;
  const Index functions = table.functions.at(window), terms = gp::countTerms(parts.structure.trend, p);
  if (parts.slope_points < 0 || parts.slope_points > n || parts.slope_variables < 0 ||
      parts.slope_variables > p) {
    throw std::invalid_argument("a surrogate has slopes at points or of variables that it lacks");
  }
  parts.hyperparameters = {numbers.length_scales.take(p, 1), table.nuggets(static_cast<Index>(window))};
  parts.scaled_points = numbers.scaled_points.take(n, p);
  parts.weights = numbers.weights.take(n + parts.slope_points * parts.slope_variables, functions);
  parts.coefficients = numbers.coefficients.take(terms, functions);
  if (!parts.structure.slopes) {
    parts.factor_tiles = numbers.factor_tiles.take(linalg::PackedLower::countTiles(n), 1);
    parts.solved_terms = numbers.solved_terms.take(n, terms);
    parts.term_factor = numbers.term_factors.take(terms, terms);
  }
  parts.amplitude = numbers.amplitudes.take(functions, 1);
  parts.left_out_ratio = numbers.left_out_ratios.take(n, 1);
  return parts;
}

void writeWindows(Hdf5Writer& file, const std::string& group, const std::vector<gp::SharedProcess>& windows) {
  WindowTable table;
  table.nuggets.resize(static_cast<Index>(windows.size()));
  WindowNumbers numbers;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    table.nuggets(static_cast<Index>(w)) = windows[w].getHyperparameters().nugget;
    appendProcess(windows[w].getParts(), table, numbers);
  }
  file.write(group + "/covariance", table.covariances);
  file.write(group + "/trend", table.trends);
  file.write(group + "/functions", table.functions);
  file.write(group + "/slope_points", table.slope_points);
  file.write(group + "/slope_variables", table.slope_variables);
  file.write(group + "/nugget", table.nuggets);
  forEachKind(numbers,
              [&](const char* name, const Flat& flat) { file.write(group + "/" + name, flat.getNumbers()); });
}

std::vector<gp::SharedProcess> readWindows(const Hdf5Reader& file, const std::string& group, Index p,
                                           Index n) {
  const WindowTable table{
      file.readTexts(group + "/covariance"),         file.readTexts(group + "/trend"),
      file.readIntegers(group + "/functions"),       file.readIntegers(group + "/slope_points"),
      file.readIntegers(group + "/slope_variables"), file.readVector(group + "/nugget")};
  if (!describesEachWindow(table)) {
    throw std::runtime_error(file.getPath() + ": " + group + " does not describe each window");
  }
  WindowNumbers numbers;
  forEachKind(numbers,
              [&](const char* name, Flat& flat) { flat = Flat(file.readVector(group + "/" + name)); });
  std::vector<gp::SharedProcess> windows;
  for (std::size_t w = 0; w < table.functions.size(); ++w) {
    windows.emplace_back(take(table, w, p, n, numbers));
  }
  return windows;
}

bool fitsTogether(const ForwardSurrogate& surrogate) {
  const Index r = surrogate.projection.rows();
  Index functions = 0;
  for (const gp::SharedProcess& window : surrogate.windows) {
    functions += window.getFunctionCount();
  }
  return r > 0 && functions == r && surrogate.projection.cols() == surrogate.center.size() &&
         surrogate.points.size() > 0 && surrogate.scores.rows() == r &&
         surrogate.scores.cols() == surrogate.points.cols() && surrogate.error_correlation.rows() == r &&
         surrogate.error_correlation.cols() == r && surrogate.error_variance.size() == r;
}

bool fitsTogether(const Surrogate& surrogate) {
  const Index variables = surrogate.forward->points.rows();
  return surrogate.center.size() == variables && surrogate.half_width.size() == variables &&
         surrogate.parameters > 0 && surrogate.parameters <= surrogate.unknown &&
         surrogate.unknown <= variables && fitsParameters(surrogate.validation, surrogate.parameters) &&
         surrogate.validation.limit_scale.size() == surrogate.parameters;
}

void requireFit(bool fits, const Hdf5Reader& file, const std::string& group) {
  if (!fits) {
    throw std::runtime_error(file.getPath() + ": " + group + " has parts that do not fit each other");
  }
}

}  // namespace

void writeForward(Hdf5Writer& file, const std::string& group, const ForwardSurrogate& surrogate) {
  file.write(group + "/center", surrogate.center);
  file.writeSamples(group + "/projection", surrogate.projection);
  file.writeSamples(group + "/points", surrogate.points);
  file.writeSamples(group + "/scores", surrogate.scores);
  file.writeSamples(group + "/error_correlation", surrogate.error_correlation);
  file.write(group + "/error_variance", surrogate.error_variance);
  writeWindows(file, group + "/windows", surrogate.windows);
}

ForwardSurrogate readForward(const Hdf5Reader& file, const std::string& group) {
  ForwardSurrogate surrogate;
  surrogate.center = file.readVector(group + "/center");
  surrogate.projection = file.readSamples(group + "/projection");
  surrogate.points = file.readSamples(group + "/points");
  surrogate.scores = file.readSamples(group + "/scores");
  surrogate.error_correlation = file.readSamples(group + "/error_correlation");
  surrogate.error_variance = file.readVector(group + "/error_variance");
  surrogate.windows = readWindows(file, group + "/windows", surrogate.points.rows(), surrogate.points.cols());
  requireFit(fitsTogether(surrogate), file, group);
  return surrogate;
}

void writePrior(Hdf5Writer& file, const std::string& group, const BoxPrior& prior) {
  if (!prior.isUniform()) {
    file.write(group + "/mean", prior.mean);
    file.writeSamples(group + "/relative", prior.relative);
    file.writeSamples(group + "/within", prior.within);
    file.write(group + "/shift", prior.shift);
    file.write(group + "/stddev", prior.stddev);
  }
}

BoxPrior readPrior(const Hdf5Reader& file, const std::string& group, Index unknown) {
  if (!file.contains(group + "/mean")) {
    return makeUniformPrior(unknown);
  }
  BoxPrior prior{file.readVector(group + "/mean"), file.readSamples(group + "/relative"),
                 file.readSamples(group + "/within"), file.readVector(group + "/shift"),
                 file.readVector(group + "/stddev")};
  const auto is_square = [&](const MatrixXd& matrix) {
    return matrix.rows() == unknown && matrix.cols() == unknown;
  };
  requireFit(prior.count() == unknown && is_square(prior.relative) && is_square(prior.within) &&
                 prior.shift.size() == unknown && prior.stddev.size() == unknown,
             file, group);
  return prior;
}

void writeSurrogate(Hdf5Writer& file, const std::string& group, const Surrogate& surrogate) {
  writeForward(file, group + "/forward", *surrogate.forward);
  file.write(group + "/box/center", surrogate.center);
  file.write(group + "/box/half_width", surrogate.half_width);
  file.write(group + "/parameters", static_cast<double>(surrogate.parameters));
  file.write(group + "/unknown", static_cast<double>(surrogate.unknown));
  writePrior(file, group + "/prior", surrogate.prior);
  writeValidation(file, group + "/validation", surrogate.validation);
}

Surrogate readSurrogate(const Hdf5Reader& file, const std::string& group) {
  Surrogate surrogate;
  surrogate.forward = std::make_shared<const ForwardSurrogate>(readForward(file, group + "/forward"));
  surrogate.center = file.readVector(group + "/box/center");
  surrogate.half_width = file.readVector(group + "/box/half_width");
  surrogate.parameters = file.readCount(group + "/parameters");
  surrogate.unknown = file.readCount(group + "/unknown");
  surrogate.validation = readValidation(file, group + "/validation");
  requireFit(fitsTogether(surrogate), file, group);
  surrogate.prior = readPrior(file, group + "/prior", surrogate.unknown);
  return surrogate;
}

void writeValidation(Hdf5Writer& file, const std::string& group, const SurrogateValidation& validation) {
  file.write(group + "/stddev_scale", validation.stddev_scale);
  file.write(group + "/coverage95", validation.coverage95);
  file.writeSamples(group + "/residual_correlation", validation.residual_correlation);
  file.write(group + "/log_density", validation.log_density);
  file.write(group + "/limit_scale", validation.limit_scale);
  file.write(group + "/limit_ratio", validation.limit_ratio);
  file.write(group + "/status", static_cast<double>(validation.status));
  if (validation.interval_factors.isGiven()) {
    file.write(group + "/interval_factor50", validation.interval_factors.of50.col(0));
    file.write(group + "/interval_factor95", validation.interval_factors.of95.col(0));
  }
}

SurrogateValidation readValidation(const Hdf5Reader& file, const std::string& group) {
  return {
      file.readVector(group + "/stddev_scale"),
      file.readVector(group + "/coverage95"),
      file.readSamples(group + "/residual_correlation"),
      file.readNumber(group + "/log_density"),
      file.readVector(group + "/limit_scale"),
      file.readVector(group + "/limit_ratio"),
      file.readNumber(group + "/status") == 0.0 ? SurrogateStatus::kOk : SurrogateStatus::kEstimatorLimited,
      file.contains(group + "/interval_factor95")
          ? IntervalFactors{file.readVector(group + "/interval_factor50"),
                            file.readVector(group + "/interval_factor95")}
          : IntervalFactors{}};
}

bool fitsParameters(const SurrogateValidation& validation, Eigen::Index parameters) {
  const IntervalFactors& factors = validation.interval_factors;
  return validation.stddev_scale.size() == parameters &&
         validation.residual_correlation.rows() == parameters &&
         validation.residual_correlation.cols() == parameters &&
         (!factors.isGiven() || (factors.of50.size() == parameters && factors.of95.size() == parameters));
}

}  // namespace twinmap
