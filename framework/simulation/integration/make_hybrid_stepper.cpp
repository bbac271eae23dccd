#include "framework/simulation/integration/make_hybrid_stepper.hpp"

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "framework/simulation/integration/radau_stepper.hpp"

namespace twinmap {
namespace {

namespace odeint = boost::numeric::odeint;

class ExplicitStepper final : public HybridStepper {
  using Controlled = odeint::controlled_runge_kutta<odeint::runge_kutta_dopri5<State>>;

  static auto makeSystem(OdeProblem& problem) {
    return [&problem](const State& x, State& dxdt, double t) { problem.calcDerivative(t, x, dxdt); };
  }

 public:
  explicit ExplicitStepper(const IntegrationOptions& options)
      : controlled_(Controlled::error_checker_type(options.absolute_tolerance, options.relative_tolerance)) {}

  bool tryStep(OdeProblem& problem, const Point& from, Point& to, double& dt) override {
    to.t = from.t;
    return controlled_.try_step(makeSystem(problem), from.x, from.dxdt, to.t, to.x, to.dxdt, dt) ==
           odeint::success;
  }
  void doStep(OdeProblem& problem, const Point& from, double t_new, Point& to) override {
    to.t = t_new;
    controlled_.stepper().do_step(makeSystem(problem), from.x, from.dxdt, from.t, to.x, to.dxdt,
                                  t_new - from.t);
  }
  void interpolate(double t, const Point& from, const Point& to, State& x) override {
    controlled_.stepper().calc_state(t, x, from.x, from.dxdt, from.t, to.x, to.dxdt, to.t);
  }

 private:
  Controlled controlled_;
};

}  // namespace

std::unique_ptr<HybridStepper> makeHybridStepper(HybridMethod method, const IntegrationOptions& options) {
  if (method == HybridMethod::kImplicit) {
    return makeRadauStepper(options);
  }
  return std::make_unique<ExplicitStepper>(options);
}

}  // namespace twinmap
