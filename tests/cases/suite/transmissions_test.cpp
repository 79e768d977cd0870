// Armatures, couplings, screws, planar and compound joints: the core's methods and the truth 'reference' against closed
// forms, which share no code with either.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "cases/case/case_reader.h"
#include "cases/truth/truth.h"
#include "core/dynamics/integrators/integrator.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_suite_transmissions)

namespace {

const struct {
  const char *id, *kind;
} kForms[] = {{"joints/compound-root", "planar"},
              {"joints/planar-slide", "planar"},
              {"transmissions/armature-hinge", "transmission"},
              {"transmissions/armature-pendulum", "pendulum"},
              {"transmissions/armature-slider", "slider"},
              {"transmissions/gear-pair", "transmission"},
              {"transmissions/rack-and-pinion", "transmission"},
              {"transmissions/screw-under-gravity", "transmission"}};

// The farthest body, in m and rad.
double apart(BodyColumns one, BodyColumns other) {
  double most = 0;
  for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, test::difference(one.body(i), other.body(i)).pose);
  return most;
}

double error_of(const Scene& scene, const Truth& truth, const std::string& method, double dt, double end) {
  return apart(test::state_after(scene, method, dt, end).columns(),
               test::truth_at(truth, end, scene.bodies.size()).columns());
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_best_method_meets_each_closed_form_to_1e_minus_9) {
  for (const auto& form : kForms) {
    const Scene scene = test::suite_scene(form.id);
    const auto truth = make_truth(form.kind, scene, 5);
    for (const double end : {0.5, 2.0, 5.0}) {
      const double error = error_of(scene, *truth, "dormand-prince", 0.01, end);
      BOOST_TEST_CONTEXT(form.id << " at " << end << " s: " << error) BOOST_TEST(error < 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(every_method_that_takes_joints_keeps_its_order) {
  for (const auto& form : kForms) {
    const Scene scene = test::suite_scene(form.id);
    const auto truth = make_truth(form.kind, scene, 1);
    for (const Integrator& row : integrators()) {
      if (!row.takes_joints || row.adaptive) continue;
      if (!row.takes_dampers_with_joints && std::string(form.id) == "transmissions/armature-slider") continue;
      const double coarse = error_of(scene, *truth, row.name, 0.01, 1),
                   fine = error_of(scene, *truth, row.name, 0.005, 1);
      constexpr double kRounding = 1e-10;
      BOOST_TEST_CONTEXT(form.id << " by " << row.name << ": " << coarse << " and " << fine)
      BOOST_TEST((fine < kRounding || std::log2(coarse / fine) > row.order - 0.3));
    }
  }
}

// The rotor and the gear move with a base that turns: no closed form, but two derivations that agree.
BOOST_AUTO_TEST_CASE(every_method_keeps_its_order_on_a_moving_base) {
  for (const char* id : {"transmissions/armature-on-moving-base", "transmissions/geared-arm"}) {
    const Scene scene = test::suite_scene(id);
    const auto truth = make_truth("reference", scene, 1);
    BOOST_TEST(truth->error(1) < 1e-10);
    for (const Integrator& row : integrators()) {
      if (!row.takes_joints || row.adaptive) continue;
      const double coarse = error_of(scene, *truth, row.name, 0.0025, 1),
                   fine = error_of(scene, *truth, row.name, 0.00125, 1);
      constexpr double kRounding = 1e-9;
      BOOST_TEST_CONTEXT(id << " by " << row.name << ": " << coarse << " and " << fine)
      BOOST_TEST((fine < kRounding || std::log2(coarse / fine) > row.order - 0.3));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_reference_meets_closed_forms_within_its_error) {
  for (const auto& form : kForms) {
    const Scene scene = test::suite_scene(form.id);
    const auto closed = make_truth(form.kind, scene, 5), solved = make_truth("reference", scene, 5);
    BOOST_TEST(solved->error(5) < 1e-9);
    for (const double t : {0.7, 2.0, 5.0}) {
      const double off = apart(test::truth_at(*closed, t, scene.bodies.size()).columns(),
                               test::truth_at(*solved, t, scene.bodies.size()).columns());
      BOOST_TEST_CONTEXT(form.id << " at " << t << " s: " << off) BOOST_TEST(off < 1e-10);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
