// Orbits on every instruction set that was compiled and that this CPU has.  Standard input: the numbers of
// trum_orbit_in, point after point.  Standard output: a line a set and point, its name and the numbers of trum_orbit_out,
// in hexadecimal.
#include <cstdio>
#include <cstdlib>

#include "cpu.hpp"
#include "orbit.hpp"

namespace {

void show(const trum::OrbitCode& code, const trum_orbit_in* points, trum_orbit_out* found, long count) {
  code.orbits(points, found, nullptr, nullptr, count);
  for (long i = 0; i < count; ++i) {
    std::printf("%s", code.name);
#define TRUM_SHOW(name, unit) std::printf(" %a", found[i].name);
    TRUM_ORBIT_OUT(TRUM_SHOW)
    std::printf("\n");
  }
}

}  // namespace

int main() {
  const long most = 10000;
  trum_orbit_in* points = static_cast<trum_orbit_in*>(std::malloc(most * sizeof(trum_orbit_in)));
  trum_orbit_out* found = static_cast<trum_orbit_out*>(std::malloc(most * sizeof(trum_orbit_out)));
  long count = 0;
  if (points == nullptr || found == nullptr) return 1;
  for (; count < most; ++count) {
    int read = 0, wanted = 0;
#define TRUM_TAKE(name, unit) ++wanted, read += std::scanf("%lf", &points[count].name) == 1;
    TRUM_ORBIT_IN(TRUM_TAKE)
    if (read < wanted) break;
  }
  show(trum::orbit_baseline, points, found, count);
#if defined(TRUM_X86_ORBITS)
  const trum::Cpu cpu = trum::this_cpu();
  if (cpu.avx2) show(trum::orbit_avx2, points, found, count);
  if (cpu.avx512) show(trum::orbit_avx512, points, found, count);
#endif
  std::free(points), std::free(found);
}
