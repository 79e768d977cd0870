// The cases of drives/: closed forms against the truth 'reference', and against the core's methods at steps that do not
// meet the samples and corners.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "cases/truth/truth.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/joint_coordinate.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_suite_drives)

namespace {

struct Motion {
  double x, rate;
};

// Each sample's torque holds for 0.1 s: I x'' = u.
Motion sampled_pd(double t) {
  constexpr double kPeriod = 0.1, kInertia = 0.6;
  double x = 0, rate = 0;
  for (double from = 0;; from += kPeriod) {
    const double turning = (3 * (1 - x) - 1.5 * rate) / kInertia, h = std::min(kPeriod, t - from);
    x += rate * h + turning * h * h / 2, rate += turning * h;
    if (t - from <= kPeriod) return {x, rate};
  }
}

// x - 1 from t = 0 on, where nothing saturates: a damped oscillation of 50 1/s² and 10 1/s.
Motion linear_servo(const Motion& start, double t) {
  const double w = std::sqrt(50.0 - 25), y = start.x - 1, c = (start.rate + 5 * y) / w, fade = std::exp(-5 * t);
  const double value = fade * (y * std::cos(w * t) + c * std::sin(w * t));
  return {1 + value, -5 * value + fade * w * (c * std::cos(w * t) - y * std::sin(w * t))};
}
Motion pushed(const Motion& start, double push, double t) {
  return {start.x + start.rate * t + push * t * t / 2, start.rate + push * t};
}
double asked(const Motion& at) { return 50 * (1 - at.x) - 10 * at.rate; }

// The first instant in (0, end] at which `law` has come above zero; `end` if it does not.
double first_rise(const std::function<double(double)>& law, double end) {
  constexpr double kStep = 1e-3, kLater = 1e-9;  // s: phases are longer; each begins at a root
  double before = kLater;
  while (before < end && !(law(std::min(before + kStep, end)) > 0)) before += kStep;
  if (before >= end) return end;
  double after = std::min(before + kStep, end);
  for (int i = 0; i < 60; ++i) (law((before + after) / 2) > 0 ? after : before) = (before + after) / 2;
  return after;
}

// Pieces that are parabolas at 2 N or -2 N, or linear.
Motion servo_saturated(double t) {
  Motion now{0, 0};
  int side = 1;
  for (double from = 0; from < t;) {
    const auto later = [&](double s) { return side != 0 ? pushed(now, 2 * side, s) : linear_servo(now, s); };
    const double length = first_rise(
        [&](double s) { return side != 0 ? 2 - side * asked(later(s)) : std::abs(asked(later(s))) - 2; }, t - from);
    now = later(length), from += length;
    side = side != 0 ? 0 : asked(now) > 0 ? 1 : -1;
  }
  return now;
}

// y = x - 0.97 starts at -0.97; in half swing n it swings about -0.05 or 0.05.
Motion friction_slider(double t) {
  const double half = std::numbers::pi / 10;
  const int n = static_cast<int>(t / half);
  if (n >= 10) return {1, 0};  // the tenth went from y = 0.07 over 0.05 to 0.03
  const double side = n % 2 == 0 ? -1 : 1, reach = 0.97 - 0.1 * n, middle = side * 0.05, s = t - n * half;
  return {0.97 + middle + side * (reach - 0.05) * std::cos(10 * s), -10 * side * (reach - 0.05) * std::sin(10 * s)};
}

// 2 t, then 2 - 2 (t - 1), then -2 + 2 (t - 3) rad/s².
Motion torque_in_time(double t) {
  if (t <= 1) return {t * t * t / 3, t * t};
  if (t <= 3)
    return {1.0 / 3 + (t - 1) + (t - 1) * (t - 1) - std::pow(t - 1, 3) / 3, 1 + 2 * (t - 1) - (t - 1) * (t - 1)};
  const double s = std::min(t - 3, 1.0);
  return {1.0 / 3 + 2 + 4 - 8.0 / 3 + s - s * s + s * s * s / 3, 1 - 2 * s + s * s};
}

const struct {
  const char* id;
  Motion (*at)(double);
} kForms[] = {{"drives/sampled-pd", sampled_pd},
              {"drives/servo-saturated", servo_saturated},
              {"drives/friction-slider", friction_slider},
              {"drives/torque-in-time", torque_in_time}};

// The distance of a joint's coordinate from the closed form, whole turns aside [rad, m], and of its rate.
Motion off(const Scene& scene, const Motion& wanted, BodyColumns bodies) {
  const JointCoordinate coordinate(scene, scene.joints.at(0));
  const JointCoordinate::Value at = coordinate.at(bodies);
  return {std::abs(coordinate.with_turns(at.x, wanted.x) - wanted.x), std::abs(at.rate - wanted.rate)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_reference_meets_each_closed_form_within_its_error) {
  for (const auto& form : kForms) {
    const Scene scene = test::suite_scene(form.id);
    const auto truth = make_truth("reference", scene, 5);
    BOOST_TEST_CONTEXT(form.id << ", error " << truth->error(5)) {
      BOOST_TEST(truth->error(5) < 1e-10);
      for (const double t : {0.31, 0.77, 0.81, 0.9, 1.234, 2.0, 2.9, 3.05, 3.7, 5.0}) {
        const Motion apart = off(scene, form.at(t), test::truth_at(*truth, t, 1).columns());
        BOOST_TEST_CONTEXT("at " << t << " s") {
          BOOST_TEST(apart.x < 1e-11);
          BOOST_TEST(apart.rate < 1e-10);
        }
      }
    }
  }
}

// 1/7 s meets neither samples nor corners, and leaps over a whole phase of the servo.
BOOST_AUTO_TEST_CASE(the_adaptive_method_meets_each_closed_form_at_any_step) {
  for (const auto& form : kForms) {
    const Scene scene = test::suite_scene(form.id);
    for (const double dt : {0.01, 1.0 / 30, 1.0 / 7}) {
      const double end = std::round(3.1 / dt) * dt;
      const Motion apart = off(scene, form.at(end), test::state_after(scene, "dormand-prince", dt, end).columns());
      BOOST_TEST_CONTEXT(form.id << " at dt " << dt << ": off by " << apart.x << ", " << apart.rate) {
        BOOST_TEST(apart.x < 1e-9);
        BOOST_TEST(apart.rate < 1e-8);
      }
    }
  }
}

// Every method that takes joints is exact where the motion is a parabola between samples, whatever its step.
BOOST_AUTO_TEST_CASE(methods_keep_their_order_across_samples_bounds_and_corners) {
  for (const auto& form : kForms) {
    const Scene scene = test::suite_scene(form.id);
    for (const Integrator& row : integrators()) {
      if (!row.takes_joints || row.adaptive || row.order > 4) continue;
      if (!row.takes_dampers_with_joints && std::string(form.id) == "drives/servo-saturated") continue;
      const auto error = [&](double dt) {
        double sum = 0;  // of several instants: an error may pass through zero
        for (const double end : {0.7, 1.4, 2.8}) {
          const double steps = std::round(end / dt);
          sum += off(scene, form.at(steps * dt), test::state_after(scene, row.name, dt, steps * dt).columns()).x;
        }
        return sum;
      };
      constexpr double kRounding = 1e-10;
      const double coarse = error(0.01), fine = error(0.005);
      BOOST_TEST_CONTEXT(form.id << " by " << row.name << ": " << coarse << " and " << fine)
      BOOST_TEST((fine < kRounding || std::log2(coarse / fine) > row.order - 0.3));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
