#include "framework/models/mechanism/loops/make_loop_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/loops/closure_program.hpp"
#include "framework/models/mechanism/sampled_keys.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A vector is independent of others where more than this part of it is: links aligned to 1e-6 rad are.
constexpr double kIndependentPart = 1e-6;

std::vector<int> listAll(Index count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Columns of `vectors` that are independent, tried in the given order, by Gram and Schmidt's method; with
/// `largest` the one with the largest independent part first.
std::vector<int> pickIndependent(MatrixXd vectors, std::vector<int> order, bool largest) {
  const VectorXd lengths = vectors.colwise().norm();
  const double smallest = kIndependentPart * kIndependentPart * lengths.maxCoeff();
  const auto calcPart = [&](int i) {
    return lengths[i] > smallest ? vectors.col(i).norm() / lengths[i] : 0.0;
  };
  std::vector<int> picked;
  while (!order.empty() && static_cast<Index>(picked.size()) < vectors.rows()) {
    const auto next = largest ? std::max_element(order.begin(), order.end(),
                                                 [&](int a, int b) { return calcPart(a) < calcPart(b); })
                              : order.begin();
    const int one = *next;
    order.erase(next);
    if (calcPart(one) > kIndependentPart) {
      const VectorXd direction = vectors.col(one).normalized();
      vectors -= direction * (direction.transpose() * vectors);
      picked.push_back(one);
    } else if (largest) {
      break;
    }
  }
  std::sort(picked.begin(), picked.end());
  return picked;
}

/// Plans at one parameter set.
class LoopPlanner {
 public:
  LoopPlanner(const ModelContext& context, const LoopModel& model, const VectorXd& parameters)
      : context_(context),
        model_(model),
        program_(model),
        parameters_(parameters),
        rows_(listAll(static_cast<Index>(model.labels.size()))),
        coordinates_(listAll(model.coordinates)) {
    for (const MotionSpec& motion : context.model.system.motions) {
      const int moved = context.names.findCoordinate(motion.coordinate);
      coordinates_.erase(std::find(coordinates_.begin(), coordinates_.end(), moved));
      prescribed_ = &motion;
    }
  }

  LoopPlan plan(const VectorXd& guess) {
    const InitialSpec& initial = context_.model.initial;
    const std::vector<int> released = listReleased({&initial.coordinates});
    requireFree(guess);
    const VectorXd closed = assemble(guess, released);
    const MatrixXd columns = calcFreeColumns(closed);
    LoopPlan plan;
    plan.rows = pickIndependent(columns.transpose(), rows_, true);
    requireMoving(plan.rows.size());
    requireRegular(closed, plan.rows);
    plan.dependent = pickIndependent(calcFreeSlopes(closed)(plan.rows, Eigen::all), released, false);
    plan.dependent_rates = pickIndependent(columns(plan.rows, Eigen::all),
                                           listReleased({&initial.speeds, &initial.coordinates}), false);
    return plan;
  }

 private:
  /// Derivatives of the conditions with respect to what is not prescribed; 0 for what is.
  MatrixXd calcFreeSlopes(const VectorXd& at) { return keepFree(program_.calc(parameters_, at).slopes); }
  /// Those of their rates with respect to the rates of the coordinates.
  MatrixXd calcFreeColumns(const VectorXd& at) {
    return keepFree(program_.calc(parameters_, at).rate_columns);
  }
  MatrixXd keepFree(MatrixXd slopes) const {
    for (Index i = 0; i < slopes.cols(); ++i) {
      if (std::find(coordinates_.begin(), coordinates_.end(), i) == coordinates_.end()) {
        slopes.col(i).setZero();
      }
    }
    return slopes;
  }

  /// Conditions that only prescribed coordinates could meet break as soon as these move.
  void requireFree(const VectorXd& guess) {
    const auto count = [&](const MatrixXd& slopes) {
      return pickIndependent(slopes.transpose(), rows_, true).size();
    };
    if (prescribed_ != nullptr &&
        count(program_.calc(parameters_, guess).rate_columns) > count(calcFreeColumns(guess))) {
      throw SimulationFailure("the constraints leave no coordinate free to follow '" +
                                  prescribed_->coordinate.text + "', whose motion is prescribed",
                              prescribed_->coordinate.where);
    }
  }

  /// Coordinates in the order in which they are let go: those not given, then those given last.
  std::vector<int> listReleased(const std::vector<const std::vector<NamedExpression>*>& given) const {
    std::vector<int> held;
    for (const std::vector<NamedExpression>* values : given) {
      for (const NamedExpression& value : *values) {
        held.push_back(context_.names.findCoordinate(value.name));
      }
    }
    std::vector<int> released = coordinates_;
    for (auto one = held.rbegin(); one != held.rend(); ++one) {
      const auto found = std::find(released.begin(), released.end(), *one);
      if (found != released.end()) {  // else it is prescribed
        released.erase(found);
        released.push_back(*one);
      }
    }
    return released;
  }

  VectorXd assemble(const VectorXd& guess, const std::vector<int>& released) {
    const MatrixXd slopes = calcFreeSlopes(guess);
    const VectorXd closed =
        closeLoops(program_, parameters_, guess, rows_, pickIndependent(slopes, released, false));
    const ClosureValues at = program_.calc(parameters_, closed);
    const std::string open = describeOpenLoops(model_, at);
    if (!open.empty()) {
      const VectorXd free = closeLoops(program_, parameters_, guess, rows_, coordinates_);
      const std::string still_open = describeOpenLoops(model_, program_.calc(parameters_, free));
      throw SimulationFailure(
          still_open.empty()
              ? "the loops cannot be closed with the initial coordinates that are held: " + open +
                    "; give values within reach, or fewer of them"
              : "the constraints contradict each other, or are out of reach from the initial coordinates: " +
                    still_open,
          findOpen(at).where);
    }
    return closed;
  }

  const ClosureLabel& findOpen(const ClosureValues& at) const {
    Index worst = 0;
    at.distances.cwiseAbs().maxCoeff(&worst);
    return model_.labels[worst];
  }

  /// A machine that stands still tells nothing, unless forces in it are measured.
  void requireMoving(std::size_t kept) const {
    const auto& outputs = context_.model.outputs;
    if (kept == coordinates_.size() && prescribed_ == nullptr &&
        std::none_of(outputs.begin(), outputs.end(),
                     [](const OutputSpec& output) { return output.reaction || output.force_of; })) {
      throw SimulationFailure("the constraints hold every coordinate: nothing can move; take one of them out",
                              model_.labels.back().where);
    }
  }

  /// Conditions that are redundant here must be so a little further along the motion; where a configuration
  /// is singular, they become independent there.
  void requireRegular(const VectorXd& closed, const std::vector<int>& rows) {
    constexpr double kMove = 1e-3;  // rad or m: a singular one is then open by some 1e-6 of its lengths
    if (rows.size() == rows_.size()) {
      return;
    }
    const MatrixXd slopes = calcFreeColumns(closed);
    VectorXd some = VectorXd::Zero(closed.size());
    for (const int i : coordinates_) {
      some[i] = std::cos(1.0 + i);
    }
    const VectorXd free = some - linalg::solveMinimumNorm(slopes, slopes * some);
    if (free.norm() <= kIndependentPart * some.norm()) {
      return;  // nothing can move
    }
    const VectorXd moved =
        closeLoops(program_, parameters_, closed + kMove * free.normalized(), rows, coordinates_);
    const ClosureValues at = program_.calc(parameters_, moved);
    const std::string open = describeOpenLoops(model_, at);
    if (!open.empty() ||
        pickIndependent(calcFreeColumns(moved).transpose(), rows_, true).size() > rows.size()) {
      throw SimulationFailure(
          "the machine starts in a singular configuration, in which a loop could go on in several ways "
          "(links "
          "that are aligned); start elsewhere" +
              (open.empty() ? "" : " (a little further on, " + open + ")"),
          findOpen(at).where);
    }
  }

  const ModelContext& context_;
  const LoopModel& model_;
  ClosureProgram program_;
  const VectorXd parameters_;
  const std::vector<int> rows_;             ///< all of them
  std::vector<int> coordinates_;            ///< but those that are prescribed
  const MotionSpec* prescribed_ = nullptr;  ///< one of them, if there are any
};

}  // namespace

namespace {

/// The file's initial coordinates, and those that are prescribed as their signals start.
VectorXd calcGuess(ModelContext& context) {
  VectorXd guess = calcInitialValues(context).coordinates;
  std::vector<double> signals(context.model.excitation.size());
  context.excitation.update(context.numbers);
  context.excitation.beginPhase(0.0);
  context.excitation.calcValues(0.0, signals);
  context.excitation.mute();
  for (const MotionSpec& motion : context.model.system.motions) {
    guess[context.names.findCoordinate(motion.coordinate)] =
        signals[findSignal(context.model, motion.follows)];
  }
  return guess;
}

}  // namespace

std::shared_ptr<const LoopModel> makeLoopModel(ModelContext& context) {
  if (context.model.system.constraints.empty()) {
    return nullptr;
  }
  const VectorXd center = calcBoxCenter(collectSampled(context.model));
  try {
    context.numbers.update(center);
    checkNumbers(context);
    auto loops = std::make_shared<LoopModel>(recordLoops(context.model, context.names));
    loops->plan = LoopPlanner(context, *loops, center).plan(calcGuess(context));
    return loops;
  } catch (const SimulationFailure& failure) {
    const std::string place = toString(failure.getWhere());
    throw ExperimentError((place.empty() ? "" : place + ": ") +
                          "at the centre of the bounds: " + failure.what());
  }
}

}  // namespace twinmap
