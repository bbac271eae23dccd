#include "framework/view/make_scene.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/models/mechanism/model_context.hpp"
#include "framework/simulation/simulation_failure.hpp"
#include "framework/view/modes.hpp"
#include "framework/view/point_values.hpp"
#include "framework/view/shapes.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap::view {
namespace {

using equations::BodyValues;
using equations::SystemValues;
using Matrix = algebra::Mat33<double>;

/// As many as a page of 3 MB has room for.
int countFrames(const ModelSpec& model) {
  constexpr int kMost = 201, kPoses = 12000;
  return std::clamp(kPoses / static_cast<int>(1 + model.system.bodies.size()), 51, kMost);
}

Ellipsoid calcEllipsoid(const BodyValues<double>& body) {
  Ellipsoid ellipsoid;
  ellipsoid.frame.origin = body.center;
  if (!(body.mass > 0.0)) {
    return ellipsoid;
  }
  const Vector& c = body.center;
  const Matrix own = body.inertia - algebra::scale(body.mass, algebra::makeDiagonal(algebra::dot(c, c)) -
                                                                  algebra::outer(c, c));
  Eigen::MatrixXd tensor(3, 3);
  tensor << own.x.x, own.y.x, own.z.x, own.x.y, own.y.y, own.z.y, own.x.z, own.y.z, own.z.z;
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(tensor);
  const auto column = [&](int i) {
    return Vector{eigen.vectors(0, i), eigen.vectors(1, i), eigen.vectors(2, i)};
  };
  ellipsoid.frame.rotation = {column(0), column(1), algebra::cross(column(0), column(1))};
  const double sum = eigen.values.sum();
  const auto radius = [&](int i) {  // of an ellipsoid: I = m (b^2 + c^2) / 5 about a
    const double square = 2.5 / body.mass * (sum - 2.0 * eigen.values[i]);
    return square > 0.0 ? std::sqrt(square) : 0.0;
  };
  ellipsoid.radii = {radius(0), radius(1), radius(2)};
  return ellipsoid;
}

void addBodies(const ModelSpec& model, const SystemValues<double>& values, Scene& scene) {
  scene.bodies.emplace_back();
  scene.bodies.back().name = "ground";
  scene.bodies.back().has_mass = false;
  for (std::size_t i = 1; i < values.bodies.size(); ++i) {
    const BodyValues<double>& body = values.bodies[i];
    const Vector axis = hasAxis(body.type) ? body.axis : Vector{};
    scene.bodies.push_back({model.system.bodies[i - 1].name.text, body.parent, body.mass > 0.0,
                            calcEllipsoid(body), getEnumText(body.type), body.in_parent, axis});
  }
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    SceneBody& body = scene.bodies[i];
    body.shapes = makeShapes(model.system.bodies[i - 1], body.ellipsoid, scene.remarks);
  }
  limitTriangles(kMostTriangles, scene.bodies, scene.remarks);
}

void addLines(const SystemValues<double>& values, Scene& scene) {
  for (const auto& spring : values.elements.get<TwoPointSpring>()) {
    scene.lines.push_back({"spring", spring.from.body, spring.to.body, spring.from.point, spring.to.point});
  }
  for (const auto& damper : values.elements.get<TwoPointDamper>()) {
    scene.lines.push_back({"damper", damper.from.body, damper.to.body, damper.from.point, damper.to.point});
  }
  for (const auto& closure : values.closures) {
    if (closure.kind == equations::ClosureKind::kRod) {
      scene.lines.push_back(
          {"rod", closure.from.body, closure.to.body, closure.from.point, closure.to.point});
    }
  }
}

template <class Element, class = void>
constexpr bool kActsOnCoordinate = false;
template <class Element>
constexpr bool kActsOnCoordinate<Element, std::void_t<decltype(std::declval<Element>().coordinate)>> = true;

/// What acts on coordinates is named at their joints.
void addActing(const SystemNames& names, const SystemValues<double>& values, Scene& scene) {
  const auto add = [&](int coordinate, const std::string& kind) {
    std::vector<std::string>& acting =
        scene.bodies[names.getCoordinates()[static_cast<std::size_t>(coordinate)].body].acting;
    if (std::find(acting.begin(), acting.end(), kind) == acting.end()) {
      acting.push_back(kind);
    }
  };
  values.elements.forEachList([&](const auto& list) {
    using Element = typename std::decay_t<decltype(list)>::value_type;
    if constexpr (kActsOnCoordinate<Element>) {
      for (const Element& element : list) {
        add(element.coordinate, Element::kKind.noun);
      }
    }
  });
  for (const auto& closure : values.closures) {
    if (closure.kind == equations::ClosureKind::kGear) {
      add(closure.coordinate, "gear");
    }
  }
}

/// Of coincident points, points in planes and what rolls, once each.
void addConstraints(const SystemValues<double>& values, Scene& scene) {
  int last = -1;
  for (const auto& closure : values.closures) {
    const bool has_point =
        closure.kind == equations::ClosureKind::kPlane || closure.kind == equations::ClosureKind::kRolling;
    if (has_point && closure.constraint != last) {
      scene.marks.push_back({"constraint", "", closure.to.body, closure.to.point, {}});
      last = closure.constraint;
    }
  }
}

void addMarks(const ModelSpec& model, const SystemNames& names, const NamedValues<double>& numbers,
              const SystemValues<double>& values, Scene& scene) {
  for (const auto& force : values.elements.get<AppliedForce>()) {
    scene.marks.push_back({"force", "", force.station.body, force.station.point, {}});
  }
  for (const auto& contact : values.elements.get<Contact>()) {
    scene.marks.push_back({"contact", "", contact.station.body, contact.station.point, {}});
  }
  for (const OutputSpec& output : model.outputs) {
    const auto add = [&](const auto& at) {
      if (at) {
        scene.marks.push_back({"sensor", output.name.text, names.findBody(at->station.body),
                               numbers.calc3(at->station.point), numbers.calc3(at->direction)});
      }
    };
    add(output.position);
    add(output.velocity);
    add(output.acceleration);
    add(output.specific_force);
    add(output.angular_velocity);
  }
}

/// All coordinates, then the experiment's outputs.
ModelSpec makeDrawn(const ModelSpec& model, const std::vector<std::string>& coordinates, double end) {
  ModelSpec drawn = model;
  std::vector<OutputSpec> outputs;
  for (const std::string& coordinate : coordinates) {
    OutputSpec output;
    output.name = {"drawn " + coordinate, {}};
    output.coordinate = Name{coordinate, {}};
    outputs.push_back(output);
  }
  constexpr double kAnInstant = 1e-9;  // s: of what stands still or has modes alone, its beginning is drawn
  drawn.simulation.duration = std::max(end, kAnInstant);
  drawn.outputs.insert(drawn.outputs.begin(), outputs.begin(), outputs.end());
  return drawn;
}

Eigen::VectorXd makeTimes(const ModelSpec& model, int frames) {
  const double duration = model.simulation.duration;
  const int count = frames > 0 ? frames : countFrames(model);
  return duration > 0.0 ? Eigen::VectorXd(Eigen::VectorXd::LinSpaced(count, 0.0, duration))
                        : Eigen::VectorXd(Eigen::VectorXd::Zero(1));
}

}  // namespace

void addMotion(const ExperimentSpec& experiment, const Eigen::VectorXd& point, const std::string& motion,
               Scene& scene) {
  const bool has_bodies = !experiment.model.source;
  std::vector<std::string> coordinates;
  std::optional<PointValues> at;
  if (has_bodies) {
    at.emplace(experiment.model, point);
    coordinates = at->names.getCoordinateNames();
  }
  ModelSpec model = makeDrawn(experiment.model, coordinates, scene.times[scene.times.size() - 1]);
  const std::unique_ptr<Simulator> simulator = makeTrustedSimulator(model, scene.times);
  const ResponseLayout& layout = simulator->getLayout();
  Eigen::MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  simulator->simulate(Eigen::MatrixXd(point), response, &status);
  if (!status.ok) {
    throw SimulationFailure("the simulation failed: " + status.reason);
  }
  const Eigen::Index frames = scene.times.size(), n = static_cast<Eigen::Index>(coordinates.size());
  for (Eigen::Index i = n; scene.motions.empty() && i < layout.getOutputCount(); ++i) {
    scene.outputs.push_back({layout.output_names[i], layout.output_units[i]});
  }
  SceneMotion drawn{motion,
                    {},
                    Eigen::MatrixXd(layout.getOutputCount() - n, frames),
                    response.col(0).head(n * frames).reshaped(frames, n).transpose()};
  for (Eigen::Index output = n; output < layout.getOutputCount(); ++output) {
    drawn.outputs.row(output - n) = response.col(0).segment(layout.getRow(output, 0), frames).transpose();
  }
  for (Eigen::Index frame = 0; has_bodies && frame < frames; ++frame) {
    const auto q = drawn.coordinates.col(frame);
    drawn.poses.push_back(calcPoses(at->values, {q.begin(), q.end()}));
  }
  scene.motions.push_back(std::move(drawn));
}

namespace {

/// All but the motion.
Scene describeMechanism(Eigen::VectorXd times, const ExperimentSpec& experiment,
                        const Eigen::VectorXd& point) {
  const ModelSpec& model = experiment.model;
  Scene scene;
  scene.name = experiment.name.text;
  scene.times = std::move(times);
  if (!model.source) {
    const PointValues at(model, point);
    scene.gravity = at.values.gravity;
    addBodies(model, at.values, scene);
    addLines(at.values, scene);
    addActing(at.names, at.values, scene);
    addConstraints(at.values, scene);
    addMarks(model, at.names, at.numbers.getValues(), at.values, scene);
  }
  return scene;
}

/// As the file says that it begins: neither an equilibrium is sought nor are loops closed.
Scene makeUnsolved(const ExperimentSpec& experiment, const Eigen::VectorXd& point) {
  Scene scene = describeMechanism(Eigen::VectorXd::Zero(1), experiment, point);
  ModelContext context(experiment.model);
  context.numbers.update(point);
  const Eigen::VectorXd q = calcInitialValues(context).coordinates;
  const PointValues at(experiment.model, point);
  scene.motions.push_back({"", {calcPoses(at.values, {q.begin(), q.end()})}, Eigen::MatrixXd(0, 1), q});
  return scene;
}

}  // namespace

Scene makeScene(const ExperimentSpec& experiment, const Eigen::VectorXd& point, const std::string& motion,
                int frames) {
  try {
    Scene scene = describeMechanism(makeTimes(experiment.model, frames), experiment, point);
    addMotion(experiment, point, motion, scene);
    addModes(experiment.model, point, scene);
    return scene;
  } catch (const SimulationFailure& failure) {
    if (experiment.model.source) {
      throw;
    }
    Scene still = makeStill(experiment, point);
    still.remarks.push_back("the mechanism stands still: " + std::string(failure.what()));
    return still;
  }
}

Scene makeStill(const ExperimentSpec& experiment, const Eigen::VectorXd& point) {
  try {
    Scene scene = describeMechanism(Eigen::VectorXd::Zero(1), experiment, point);
    addMotion(experiment, point, "", scene);
    return scene;
  } catch (const SimulationFailure&) {
    return makeUnsolved(experiment, point);
  }
}

}  // namespace twinmap::view
