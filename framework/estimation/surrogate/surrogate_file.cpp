#include "framework/estimation/surrogate/surrogate_file.hpp"

#include <stdexcept>
#include <vector>

#include "framework/base/hdf5/hdf5_fields.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* kCovariances[] = {"squared_exponential", "matern52"};
constexpr const char* kTrends[] = {"linear", "quadratic"};

template <class Enum>
Enum parse(const std::string& text, const char* const (&names)[2]) {
  if (text != names[0] && text != names[1]) {
    throw std::runtime_error("a surrogate has an unknown '" + text + "'");
  }
  return static_cast<Enum>(text == names[1]);
}

/// The numbers of one kind of all windows, one after the other, column by column.
class Flat {
 public:
  explicit Flat(const char* name) : name_(name) {}

  void append(const MatrixXd& part) {
    const Index before = numbers_.size();
    numbers_.conservativeResize(before + part.size());
    numbers_.tail(part.size()) = Eigen::Map<const VectorXd>(part.data(), part.size());
  }

  template <class Matrix>
  void take(Matrix& part, Index rows, Index cols) {
    const Index left = numbers_.size() - taken_;
    if (rows < 0 || cols < 0 || (rows > 0 && cols > left / rows)) {
      throw std::invalid_argument("a surrogate's numbers are too few");
    }
    part = Eigen::Map<const MatrixXd>(numbers_.data() + taken_, rows, cols);
    taken_ += rows * cols;
  }

  template <class Fields>
  void list(const Fields& fields) {
    fields(name_, numbers_);
  }

 private:
  const char* name_;
  VectorXd numbers_;
  Index taken_ = 0;
};

/// What differs in size or kind from window to window, then the numbers of all.
struct WindowTable {
  std::vector<std::string> covariances, trends;
  std::vector<std::int64_t> functions, slope_points, slope_variables;
  VectorXd nuggets;
  Flat length_scales{"length_scales"}, scaled_points{"scaled_points"}, weights{"weights"},
      coefficients{"coefficients"}, factor_tiles{"factor_tiles"}, solved_terms{"solved_terms"},
      term_factors{"term_factors"}, amplitudes{"amplitudes"}, left_out_ratios{"left_out_ratios"};
};

template <class Fields>
void listWindows(const Fields& fields, WindowTable& table) {
  fields("covariance", table.covariances);
  fields("trend", table.trends);
  fields("functions", table.functions);
  fields("slope_points", table.slope_points);
  fields("slope_variables", table.slope_variables);
  fields("nugget", table.nuggets);
  for (Flat* flat :
       {&table.length_scales, &table.scaled_points, &table.weights, &table.coefficients, &table.factor_tiles,
        &table.solved_terms, &table.term_factors, &table.amplitudes, &table.left_out_ratios}) {
    flat->list(fields);
  }
}

bool describesEachWindow(const WindowTable& table) {
  const std::size_t windows = table.functions.size();
  return table.covariances.size() == windows && table.trends.size() == windows &&
         table.slope_points.size() == windows && table.slope_variables.size() == windows &&
         table.nuggets.size() == static_cast<Index>(windows);
}

/// Calls visit(all windows' numbers, those of a window of p variables and n points, rows, columns).
template <class Parts, class Visit>
void visitNumbers(WindowTable& table, Parts& parts, Index p, Index n, Index functions, const Visit& visit) {
  const Index terms = gp::countTerms(parts.structure.trend, p);
  visit(table.length_scales, parts.hyperparameters.length_scales, p, 1);
  visit(table.scaled_points, parts.scaled_points, n, p);
  visit(table.weights, parts.weights, n + parts.slope_points * parts.slope_variables, functions);
  visit(table.coefficients, parts.coefficients, terms, functions);
  if (!parts.structure.slopes) {
    visit(table.factor_tiles, parts.factor_tiles, linalg::PackedLower::countTiles(n), 1);
    visit(table.solved_terms, parts.solved_terms, n, terms);
    visit(table.term_factors, parts.term_factor, terms, terms);
  }
  visit(table.amplitudes, parts.amplitude, functions, 1);
  visit(table.left_out_ratios, parts.left_out_ratio, n, 1);
}

/// The next window of p variables and n points.
gp::SharedProcessParts take(WindowTable& table, std::size_t window, Index p, Index n) {
  gp::SharedProcessParts parts;
  parts.structure = {parse<gp::SmoothCovariance>(table.covariances.at(window), kCovariances),
                     parse<gp::Trend>(table.trends.at(window), kTrends)};
  parts.slope_points = table.slope_points.at(window);
  parts.slope_variables = table.slope_variables.at(window);
  parts.structure.slopes = parts.slope_points > 0;
  parts.hyperparameters.nugget = table.nuggets(static_cast<Index>(window));
  if (parts.slope_points < 0 || parts.slope_points > n || parts.slope_variables < 0 ||
      parts.slope_variables > p) {
    throw std::invalid_argument("a surrogate has slopes at points or of variables that it lacks");
  }
  visitNumbers(table, parts, p, n, table.functions.at(window),
               [](Flat& flat, auto& part, Index rows, Index cols) { flat.take(part, rows, cols); });
  return parts;
}

void listProcesses(const WrittenFields& fields, const std::vector<gp::SharedProcess>& windows, Index p,
                   Index n) {
  WindowTable table;
  table.nuggets.resize(static_cast<Index>(windows.size()));
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const gp::SharedProcessParts parts = windows[w].getParts();
    table.covariances.emplace_back(kCovariances[static_cast<int>(parts.structure.covariance)]);
    table.trends.emplace_back(kTrends[static_cast<int>(parts.structure.trend)]);
    table.functions.push_back(parts.weights.cols());
    table.slope_points.push_back(parts.slope_points);
    table.slope_variables.push_back(parts.slope_variables);
    table.nuggets(static_cast<Index>(w)) = parts.hyperparameters.nugget;
    visitNumbers(table, parts, p, n, parts.weights.cols(),
                 [](Flat& flat, const auto& part, Index, Index) { flat.append(part); });
  }
  listWindows(fields, table);
}

void listProcesses(const ReadFields& fields, std::vector<gp::SharedProcess>& windows, Index p, Index n) {
  WindowTable table;
  listWindows(fields, table);
  fields.require(describesEachWindow(table));
  for (std::size_t w = 0; w < table.functions.size(); ++w) {
    windows.emplace_back(take(table, w, p, n));
  }
}

template <class Fields, class Forward>
void listForward(const Fields& fields, Forward& surrogate) {
  fields("center", surrogate.center);
  fields("projection", surrogate.projection);
  fields("points", surrogate.points);
  fields("scores", surrogate.scores);
  fields("error_correlation", surrogate.error_correlation);
  fields("error_variance", surrogate.error_variance);
  listProcesses(fields.in("windows"), surrogate.windows, surrogate.points.rows(), surrogate.points.cols());
}

template <class Fields, class Prior>
void listPrior(const Fields& fields, Prior& prior) {
  fields("mean", prior.mean);
  fields("relative", prior.relative);
  fields("within", prior.within);
  fields("shift", prior.shift);
  fields("stddev", prior.stddev);
}

template <class Fields, class Validation>
void listValidation(const Fields& fields, Validation& validation) {
  fields("stddev_scale", validation.stddev_scale);
  fields("coverage95", validation.coverage95);
  fields("residual_correlation", validation.residual_correlation);
  fields("log_density", validation.log_density);
  fields("limit_scale", validation.limit_scale);
  fields("limit_ratio", validation.limit_ratio);
  fields.converted(
      "status", validation.status, [](SurrogateStatus status) { return static_cast<double>(status); },
      [](double read) { return read == 0.0 ? SurrogateStatus::kOk : SurrogateStatus::kEstimatorLimited; });
  auto& factors = validation.interval_factors;
  if (fields.has("interval_factor95", factors.isGiven())) {
    const auto to_vector = [](const MatrixXd& of) { return VectorXd(of.col(0)); };
    const auto to_matrix = [](const VectorXd& of) { return MatrixXd(of); };
    fields.converted("interval_factor50", factors.of50, to_vector, to_matrix);
    fields.converted("interval_factor95", factors.of95, to_vector, to_matrix);
  }
}

template <class Fields, class Map>
void listMap(const Fields& fields, Map& surrogate) {
  fields("box/center", surrogate.center);
  fields("box/half_width", surrogate.half_width);
  fields("parameters", surrogate.parameters);
  fields("unknown", surrogate.unknown);
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

}  // namespace

void writeForward(Hdf5Writer& file, const std::string& group, const ForwardSurrogate& surrogate) {
  listForward(WrittenFields(file, group), surrogate);
}

ForwardSurrogate readForward(const Hdf5Reader& file, const std::string& group) {
  ForwardSurrogate surrogate;
  const ReadFields fields(file, group);
  listForward(fields, surrogate);
  fields.require(fitsTogether(surrogate));
  return surrogate;
}

void writePrior(Hdf5Writer& file, const std::string& group, const BoxPrior& prior) {
  if (!prior.isUniform()) {
    listPrior(WrittenFields(file, group), prior);
  }
}

BoxPrior readPrior(const Hdf5Reader& file, const std::string& group, Index unknown) {
  const ReadFields fields(file, group);
  if (!fields.has("mean", true)) {
    return makeUniformPrior(unknown);
  }
  BoxPrior prior;
  listPrior(fields, prior);
  const auto is_square = [&](const MatrixXd& matrix) {
    return matrix.rows() == unknown && matrix.cols() == unknown;
  };
  fields.require(prior.count() == unknown && is_square(prior.relative) && is_square(prior.within) &&
                 prior.shift.size() == unknown && prior.stddev.size() == unknown);
  return prior;
}

void writeSurrogate(Hdf5Writer& file, const std::string& group, const Surrogate& surrogate) {
  writeForward(file, group + "/forward", *surrogate.forward);
  listMap(WrittenFields(file, group), surrogate);
  writePrior(file, group + "/prior", surrogate.prior);
  writeValidation(file, group + "/validation", surrogate.validation);
}

Surrogate readSurrogate(const Hdf5Reader& file, const std::string& group) {
  Surrogate surrogate;
  surrogate.forward = std::make_shared<const ForwardSurrogate>(readForward(file, group + "/forward"));
  const ReadFields fields(file, group);
  listMap(fields, surrogate);
  surrogate.validation = readValidation(file, group + "/validation");
  fields.require(fitsTogether(surrogate));
  surrogate.prior = readPrior(file, group + "/prior", surrogate.unknown);
  return surrogate;
}

void writeValidation(Hdf5Writer& file, const std::string& group, const SurrogateValidation& validation) {
  listValidation(WrittenFields(file, group), validation);
}

SurrogateValidation readValidation(const Hdf5Reader& file, const std::string& group) {
  SurrogateValidation validation;
  listValidation(ReadFields(file, group), validation);
  return validation;
}

bool fitsParameters(const SurrogateValidation& validation, Eigen::Index parameters) {
  const IntervalFactors& factors = validation.interval_factors;
  return validation.stddev_scale.size() == parameters &&
         validation.residual_correlation.rows() == parameters &&
         validation.residual_correlation.cols() == parameters &&
         (!factors.isGiven() || (factors.of50.size() == parameters && factors.of95.size() == parameters));
}

}  // namespace twinmap
