#include "framework/robots/bodies.hpp"

#include <algorithm>
#include <set>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap::robots {
namespace {

/// A link that a joint moves, or the root.
struct Start {
  const Link* link;
  const Joint* joint;
  Place place;  ///< of the joint's frame
};

/// A link with the frame in which its group is seen.
struct Member {
  const Link* link;
  Pose pose;           ///< in the group's first link
  const Link* holder;  ///< the nearest link with mass before it; none: there is none
};

class Assembler {
 public:
  Assembler(const Robot& robot, Base base, const std::vector<std::string>& moving)
      : robot_(robot), base_(base), moving_(moving.begin(), moving.end()) {
    for (const Link& link : robot.links) {
      links_[link.name] = &link;
    }
    for (const Joint& joint : robot.joints) {
      joints_[joint.name] = &joint;
    }
  }

  Assembly assemble() {
    checkMoving();
    connect();
    std::for_each(robot_.joints.begin(), robot_.joints.end(),
                  [this](const Joint& joint) { checkMimic(joint); });
    std::vector<Start> open{{findRoot(), nullptr, {}}};
    while (!open.empty()) {
      const Start start = open.back();
      open.pop_back();
      std::vector<Start> next = addGroup(start);
      open.insert(open.end(), next.rbegin(), next.rend());
    }
    return std::move(assembly_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& what) const { failAt(robot_.file, line, what); }

  bool moves(const Joint& joint) const {
    return joint.moves() && (moving_.empty() || moving_.count(joint.name) > 0);
  }

  void checkMoving() const {
    std::vector<std::string> names;
    for (const Joint& joint : robot_.joints) {
      if (joint.moves()) {
        names.push_back(joint.name);
      }
    }
    for (const std::string& name : moving_) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        throw ExperimentError(robot_.file + ": has no joint '" + name + "' that moves" +
                              suggestName(name, names));
      }
    }
  }

  std::vector<std::string> listJoints() const {
    std::vector<std::string> names;
    for (const Joint& joint : robot_.joints) {
      names.push_back(joint.name);
    }
    return names;
  }

  const Link* findLink(const std::string& name, int line) const {
    const auto found = links_.find(name);
    if (found == links_.end()) {
      fail(line, "has no link '" + name + "': write one, or correct the name");
    }
    return found->second;
  }

  void connect() {
    for (const Joint& joint : robot_.joints) {
      children_[findLink(joint.parent, joint.line)].push_back(&joint);
      if (!into_.emplace(findLink(joint.child, joint.line), &joint).second) {
        fail(joint.line, "link '" + joint.child +
                             "' has two joints to parents: a URDF is a tree; leave one out and "
                             "close the loop in 'constraints'");
      }
    }
  }

  const Link* findRoot() const {
    const Link* root = nullptr;
    for (const Link& link : robot_.links) {
      if (into_.count(&link) > 0) {
        continue;
      }
      if (root != nullptr) {
        fail(link.line, "link '" + link.name + "' has no joint to a parent, nor has '" + root->name +
                            "': connect one of them");
      }
      root = &link;
    }
    if (root == nullptr || countBelow(root) != robot_.links.size()) {
      fail(robot_.links.front().line,
           "joints go round in a circle: a URDF is a tree; leave one out and close the "
           "loop in 'constraints'");
    }
    return root;
  }

  std::size_t countBelow(const Link* root) const {
    std::vector<const Link*> open{root};
    for (std::size_t i = 0; i < open.size(); ++i) {
      const auto found = children_.find(open[i]);
      for (std::size_t k = 0; found != children_.end() && k < found->second.size(); ++k) {
        open.push_back(links_.at(found->second[k]->child));
      }
    }
    return open.size();
  }

  void checkMimic(const Joint& joint) const {
    if (!joint.mimic || !moves(joint)) {
      return;
    }
    std::size_t count = 0;
    for (const Joint* at = &joint; at->mimic; ++count) {
      const auto driver = joints_.find(at->mimic->joint);
      if (driver == joints_.end()) {
        fail(at->mimic->line, "joint '" + at->name + "' mimics '" + at->mimic->joint +
                                  "', but there is no such joint: correct the name" +
                                  suggestName(at->mimic->joint, listJoints()));
      }
      if (!driver->second->isSingle() || !at->isSingle()) {
        fail(at->mimic->line, "joint '" + at->name + "' mimics '" + at->mimic->joint +
                                  "': both must be joints that turn or slide");
      }
      if (!moves(*driver->second)) {
        fail(at->mimic->line, "joint '" + at->name + "' mimics '" + at->mimic->joint +
                                  "', which does not move: name both in --joints, or neither");
      }
      at = driver->second;
      if (count > joints_.size()) {
        fail(joint.mimic->line,
             "joint '" + joint.name + "' mimics joints that mimic it in the end: leave one <mimic> out");
      }
    }
  }

  /// The links that are fixed to each other, from the first one on.
  std::vector<Member> collectGroup(const Link* first) const {
    std::vector<Member> group{{first, {}, nullptr}};
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto found = children_.find(group[i].link);
      for (std::size_t k = 0; found != children_.end() && k < found->second.size(); ++k) {
        const Joint& joint = *found->second[k];
        if (!moves(joint)) {
          group.push_back({links_.at(joint.child),
                           group[i].pose * joint.frame * algebra::invert(joint.in_child),
                           group[i].link->hasMass() ? group[i].link : group[i].holder});
        }
      }
    }
    return group;
  }

  /// Adds the group's bodies; where its moving joints lead to.
  std::vector<Start> addGroup(const Start& start) {
    const std::vector<Member> group = collectGroup(start.link);
    const bool on_ground = start.joint == nullptr && base_ == Base::kFixed;
    const Link* head = nullptr;  // that others hold to which have none before them
    Pose head_pose;
    const auto first =
        std::find_if(group.begin(), group.end(), [](const Member& one) { return one.link->hasMass(); });
    if (!on_ground) {
      const bool massless = first == group.end();
      requireMass(start, !massless || isFollowed(group));
      head = massless ? start.link : first->link;
      head_pose = massless ? Pose{} : first->pose;
      const Pose in_link = start.joint != nullptr ? start.joint->in_child : Pose{};
      assembly_.bodies.push_back({head, start.place.body != nullptr ? start.place.body->name : "",
                                  start.joint, start.joint == nullptr, false, massless, start.place.frame,
                                  algebra::invert(head_pose) * in_link});
    }
    std::map<const Link*, Pose> poses;
    for (const Member& member : group) {
      poses[member.link] = member.pose;
    }
    std::vector<Start> next;
    for (const Member& member : group) {
      const Link* holder = member.holder != nullptr ? member.holder : head;
      const Pose base = holder != nullptr ? poses.at(holder) : Pose{};
      if (member.link->hasMass() && member.link != head) {
        assembly_.bodies.push_back({member.link,
                                    holder != nullptr ? holder->name : "",
                                    nullptr,
                                    false,
                                    on_ground,
                                    false,
                                    algebra::invert(base) * member.pose,
                                    {}});
      }
      addMoving(member, holder, base, next);
    }
    return next;
  }

  void addMoving(const Member& member, const Link* holder, const Pose& base, std::vector<Start>& next) {
    const auto found = children_.find(member.link);
    const Place place =
        member.link->hasMass() ? Place{member.link, {}} : Place{holder, algebra::invert(base) * member.pose};
    assembly_.places[member.link->name] = place;
    for (std::size_t k = 0; found != children_.end() && k < found->second.size(); ++k) {
      const Joint& joint = *found->second[k];
      if (moves(joint)) {
        next.push_back({links_.at(joint.child), &joint, {place.body, place.frame * joint.frame}});
      }
    }
  }

  /// Whether a joint moves something further out.
  bool isFollowed(const std::vector<Member>& group) const {
    return std::any_of(group.begin(), group.end(), [this](const Member& member) {
      const auto found = children_.find(member.link);
      return found != children_.end() && std::any_of(found->second.begin(), found->second.end(),
                                                     [this](const Joint* joint) { return moves(*joint); });
    });
  }

  void requireMass(const Start& start, bool has_mass) const {
    if (!has_mass && start.joint == nullptr) {
      fail(start.link->line, "link '" + start.link->name +
                                 "' is a free base without mass: give it <inertial>, or --base fixed");
    }
    if (!has_mass) {
      fail(start.link->line,
           "link '" + start.link->name + "' has no mass, but joint '" + start.joint->name +
               "' moves it: give it <inertial> with a mass, make the joint fixed, or leave it out "
               "of --joints");
    }
  }

  const Robot& robot_;
  Base base_;
  std::set<std::string> moving_;
  std::map<std::string, const Link*> links_;
  std::map<std::string, const Joint*> joints_;
  std::map<const Link*, std::vector<const Joint*>> children_;
  std::map<const Link*, const Joint*> into_;
  Assembly assembly_;
};

}  // namespace

Assembly assembleBodies(const Robot& robot, Base base, const std::vector<std::string>& moving) {
  return Assembler(robot, base, moving).assemble();
}

}  // namespace twinmap::robots
