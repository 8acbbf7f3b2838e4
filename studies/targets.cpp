// Orbits on every instruction set that was compiled and that this CPU has.  Standard input: the numbers of
// trum_orbit_in, point after point.  Standard output: a line a set and point, its name and the numbers of trum_orbit_out,
// in hexadecimal.
#include <cstdio>
#include <vector>

#include "cpu.hpp"
#include "orbit.hpp"

namespace {

void show(const trum::OrbitCode& code, const std::vector<trum_orbit_in>& points) {
  std::vector<trum_orbit_out> found(points.size());
  code.orbits(points.data(), found.data(), nullptr, nullptr, static_cast<long>(points.size()));
  for (const trum_orbit_out& out : found) {
    std::printf("%s", code.name);
#define TRUM_SHOW(name, unit) std::printf(" %a", out.name);
    TRUM_ORBIT_OUT(TRUM_SHOW)
    std::printf("\n");
  }
}

}  // namespace

int main() {
  std::vector<trum_orbit_in> points;
  for (trum_orbit_in in;;) {
    int read = 0, wanted = 0;
#define TRUM_TAKE(name, unit) ++wanted, read += std::scanf("%lf", &in.name) == 1;
    TRUM_ORBIT_IN(TRUM_TAKE)
    if (read < wanted) break;
    points.push_back(in);
  }
  show(trum::orbit_baseline, points);
#if defined(TRUM_X86_ORBITS)
  const trum::Cpu cpu = trum::this_cpu();
  if (cpu.avx2) show(trum::orbit_avx2, points);
  if (cpu.avx512) show(trum::orbit_avx512, points);
#endif
}
