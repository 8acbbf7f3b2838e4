// What an x86-64 CPU and its operating system have, by the CPU's own word: __builtin_cpu_supports needs a run-time
// library that not every compiler of Windows links.
#pragma once

#if defined(__x86_64__) || defined(_M_X64)
#if defined(_MSC_VER)
#include <intrin.h>
#else
#include <cpuid.h>
#endif

namespace trum {

inline void cpu_leaf(unsigned leaf, unsigned (&found)[4]) {
#if defined(_MSC_VER)
  int registers[4];
  __cpuidex(registers, static_cast<int>(leaf), 0);
  for (int k = 0; k < 4; ++k) found[k] = static_cast<unsigned>(registers[k]);
#else
  __cpuid_count(leaf, 0, found[0], found[1], found[2], found[3]);
#endif
}

// Which registers the operating system keeps when it switches threads; only where the CPU has the instruction.
inline unsigned kept_registers() {
#if defined(_MSC_VER)
  return static_cast<unsigned>(_xgetbv(0));
#else
  unsigned low, high;
  __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
#endif
}

struct Cpu {
  bool avx2 = false;    // with fused multiply-add
  bool avx512 = false;  // F, DQ and VL
};

// The bits are those of Intel's manual, volume 2, CPUID, and volume 1, Sect. 13.3 (XCR0).
inline Cpu this_cpu() {
  unsigned most[4], first[4], seventh[4];  // eax, ebx, ecx, edx
  cpu_leaf(0, most);
  if (most[0] < 7) return {};
  cpu_leaf(1, first);
  cpu_leaf(7, seventh);
  const auto bit = [](unsigned of, int at) { return (of >> at & 1) != 0; };
  if (!bit(first[2], 27)) return {};  // no xgetbv
  const unsigned kept = kept_registers();
  Cpu cpu;
  cpu.avx2 = (kept & 0x6) == 0x6 && bit(first[2], 12) && bit(first[2], 28) && bit(seventh[1], 5);
  cpu.avx512 = cpu.avx2 && (kept & 0xE6) == 0xE6 && bit(seventh[1], 16) && bit(seventh[1], 17) && bit(seventh[1], 31);
  return cpu;
}

}  // namespace trum
#endif
