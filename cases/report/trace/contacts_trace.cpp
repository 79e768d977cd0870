// Contact forces as CSV: one row per contact point and sample. The force on b is a mean over the step that ends at
// `time`; the normal points from a to b, and a negative gap is an overlap.
#include "cases/report/csv/trajectory_csv.h"
#include "cases/report/trace/trace_formats.h"

namespace rigor::inline report {
namespace {

class ContactsTrace : public TraceWriter {
 public:
  explicit ContactsTrace(const Scene& scene) : scene_(scene) {}
  std::string begin(std::size_t) override { return "time,a,b,px,py,pz,nx,ny,nz,gap,fx,fy,fz\n"; }
  std::string add(const Sample& sample) override {
    std::string rows;
    for (const ReportedContact& contact : sample.contacts) {
      append_number(rows, sample.time);
      for (const int body : {contact.a, contact.b}) rows += ',' + csv_field(scene_.body_name(body));
      append(rows, contact.point), append(rows, contact.normal);
      rows += ',';
      append_number(rows, contact.gap);
      append(rows, contact.force);
      rows += '\n';
    }
    return rows;
  }

 private:
  static void append(std::string& rows, const Vec3& vector) {
    for (int k = 0; k < 3; ++k) {
      rows += ',';
      append_number(rows, vector[k]);
    }
  }

  const Scene& scene_;
};

}  // namespace

std::unique_ptr<TraceWriter> contacts_trace(const Scene& scene) { return std::make_unique<ContactsTrace>(scene); }

}  // namespace rigor::inline report
