// Error against run time of one scene by every form of contact, all against one motion.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/study/contact/contact_limit.h"
#include "app/study/error/error_study.h"

namespace pneuma::app {

enum class ContactForm {
  swept,
  impulses,
  potential,
  paper,  // all by the paper's method, with its integrator
};
std::string_view to_string(ContactForm form);

struct ContactOptions {
  ErrorOptions errors;  // its flight is not used
  LimitOptions limit;
  std::optional<double> seconds;  // of the scene; none: a second from its first contact on
};
ContactOptions full_contact_options();
/// In seconds: to see that all of it works.
ContactOptions short_contact_options();

struct ContactRuns {
  ContactForm form;
  std::vector<ErrorRun> runs;  // integrator by integrator, from coarse to fine
};

struct ContactStudy {
  std::string name;  // of the scene
  std::string title;
  double seconds = 0.0;        // asked for
  double first_contact = 0.0;  // s
  double rest_radius = 0.0;    // m, of the first body
  ContactLimit limit;
  std::vector<ContactRuns> forms;
};

/// Whether anything touches in the time that is compared; otherwise the runs say nothing of
/// contacts.
bool reaches_a_contact(const ContactStudy& study);

/// A run that is good enough for something, the cheapest there is.
struct ContactChoice {
  std::string purpose;              // "picture", "1e-2", "1e-3" or "guarantee"
  bool known = true;                // the limit is known well enough to tell
  std::optional<ContactForm> form;  // nothing when none is good enough
  ErrorRun run;
};

/// For an error of 5e-2 (`--accuracy picture`), 1e-2, 1e-3; and where nothing may cross, itself
/// neither, and contacts may give no energy: the potential by an implicit integrator, for a
/// picture's error or, when none has that, as good as it gets.
std::vector<ContactChoice> choose_contacts(const ContactStudy& study);

/// The cheapest runs of a form with at most an error: from the cheapest on, each better than those
/// before.
std::vector<ErrorRun> cheapest_runs(const ContactRuns& runs);

/// Throws UsageError if nothing touches in the time, and as study_errors does.
ContactStudy study_contacts(const scenes::Scene& scene, const ContactOptions& options,
                            const std::function<void(const std::string&)>& say);

}  // namespace pneuma::app
