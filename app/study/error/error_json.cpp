#include <nlohmann/json.hpp>

#include "app/study/error/conclusions.h"
#include "app/study/error/error_report.h"

namespace pneuma::app {
namespace {

using nlohmann::json;
using Status = ErrorRun::Status;

json errors_json(const StateErrors& errors) {
  return {{"position", errors.position}, {"volume", errors.volume},
          {"centre", errors.centre},     {"energy", errors.energy},
          {"momentum", errors.momentum}, {"angular_momentum", errors.angular_momentum}};
}

json number_or_null(double value) { return value > 0.0 ? json(value) : json(nullptr); }

json run_json(const ErrorRun& run) {
  const bool stable = run.status == Status::stable;
  return {{"method", run.method},
          {"ours", run.ours},
          {"steps_per_second", run.ours ? json(run.steps_per_second) : json(nullptr)},
          {"tolerance", run.ours ? json(nullptr) : json(run.tolerance)},
          {"outcome", std::string(to_string(run.status))},
          {"failure", run.failure},
          {"run_time_s_per_simulated_s", number_or_null(run.run_time)},
          {"evaluations_per_simulated_s", number_or_null(run.evaluations)},
          {"end", stable ? errors_json(run.errors.end) : json(nullptr)},
          {"max", stable ? errors_json(run.errors.greatest) : json(nullptr)}};
}

json order_json(const ObservedOrder& order) {
  json result = {{"method", order.method},
                 {"theory", order.theory ? json(*order.theory) : json(nullptr)},
                 {"observed", nullptr}};
  if (order.law) {
    result["observed"] = {{"order", order.law->exponent},
                          {"from_steps_per_second", order.first_steps_per_second},
                          {"to_steps_per_second", order.last_steps_per_second},
                          {"points", order.points}};
  }
  return result;
}

json choice_json(const Choice& choice) {
  return {{"error", choice.error},
          {"sentence", recommendation(choice)},
          {"ours", choice.ours ? run_json(*choice.ours) : json(nullptr)},
          {"sundials", choice.peer ? run_json(*choice.peer) : json(nullptr)},
          {"sundials_over_ours", choice.ratio() ? json(*choice.ratio()) : json(nullptr)}};
}

}  // namespace

json error_json(const ErrorStudy& study) {
  json runs = json::array(), orders = json::array(), choices = json::array();
  for (const ErrorRun& run : study.runs) runs.push_back(run_json(run));
  for (const ObservedOrder& order : observed_orders(study)) orders.push_back(order_json(order));
  for (const double error : compared_errors) choices.push_back(choice_json(choose(study, error)));
  return {{"scene", study.name},
          {"title", study.title},
          {"motion", study.flight.description},
          {"contacts", study.flight.contacts},
          {"bodies", study.flight.world.soft.size() + study.flight.world.rigid.size()},
          {"vertices", study.vertices},
          {"rest_radius_m", study.rest_radius},
          {"seconds_asked_for", study.flight.seconds},
          {"seconds_compared", study.reference.seconds},
          {"reference",
           {{"method", study.reference.method},
            {"uncertainty", study.reference.uncertainty},
            {"limit", study.reference.limit}}},
          {"evaluation_s", study.evaluation_time},
          {"orders", std::move(orders)},
          {"choices", std::move(choices)},
          {"shortfalls", shortfalls(study)},
          {"runs", std::move(runs)}};
}

}  // namespace pneuma::app
