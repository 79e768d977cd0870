#include "cases/truth/provenance.h"

#include <algorithm>
#include <vector>

#include "core/dynamics/contact/contact_method.h"
#include "core/world.h"

namespace rigor::inline truth {

// One declaration and one row a truth that is solved; each is defined in the file of its name.
Provenance events_provenance();
Provenance recording_provenance();
Provenance reference_provenance();
Provenance round_on_plane_provenance();

namespace {

const Provenance* row_of(const std::string& truth) {
  static const std::vector<Provenance> table = {events_provenance(), recording_provenance(), reference_provenance(),
                                                round_on_plane_provenance()};
  const auto row = std::find_if(table.begin(), table.end(), [&](const Provenance& one) { return one.truth == truth; });
  return row == table.end() ? nullptr : &*row;
}

}  // namespace

std::string provenance_of(const std::string& truth) {
  if (truth == "none") return "";
  const Provenance* row = row_of(truth);
  return row ? row->how : "a closed form, independent of every engine and method";
}

bool is_made_like_ensembles(const RunName& run, const Scene& scene) {
  const auto& options = run.settings.options;
  return run.engine == core_info().name &&
         (!options.contains("contact") || options.at("contact") == contact_method_for(scene).name);
}

bool is_made_by(const std::string& truth, const RunName& run, const Scene& scene) {
  const Provenance* row = row_of(truth);
  return row && row->is_made_like && row->is_made_like(run, scene);
}

}  // namespace rigor::inline truth
