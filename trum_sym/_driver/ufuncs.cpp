// The Python face of the generated kernels and of the cycle driver: NumPy ufuncs, which broadcast,
// take strides and release the GIL by themselves.
#include <Python.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include <numpy/arrayobject.h>
#include <numpy/ufuncobject.h>

#include "coupled.hpp"
#include "cpu.hpp"
#include "grid.hpp"
#include "orbit.hpp"
#include "trum_brush.h"
#include "trum_cycle.h"

namespace {

using Kernel = int (*)(const double**, double**, long long int*, double*, int);

template <Kernel kernel, int n_in, int n_out>
void kernel_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  // A kernel writes its first result before it has read its last argument, and with out= both may lie in one place:
  // NumPy makes a copy only where they overlap out of step.
  double in[n_in], out[n_out];
  const double* arg[n_in];
  double* res[n_out];
  for (int j = 0; j < n_in; ++j) arg[j] = &in[j];
  for (int j = 0; j < n_out; ++j) res[j] = &out[j];
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    for (int j = 0; j < n_in; ++j) in[j] = *reinterpret_cast<const double*>(args[j] + i * steps[j]);
    kernel(arg, res, nullptr, nullptr, 0);
    for (int j = 0; j < n_out; ++j) *reinterpret_cast<double*>(args[n_in + j] + i * steps[n_in + j]) = out[j];
  }
}

// Lets other threads of the interpreter run meanwhile.  NumPy may have done so already, or not: it keeps the lock in
// short loops, and in all loops of an iterator that it has not marked as free of Python.  The stable ABI has nothing
// that tells; so the lock is taken, which does nothing where it is held, and let go.
class Unlocked {
 public:
  Unlocked() : before_(PyGILState_Ensure()), state_(PyEval_SaveThread()) {}
  ~Unlocked() {
    PyEval_RestoreThread(state_);
    PyGILState_Release(before_);
  }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyGILState_STATE before_;
  PyThreadState* state_;
};

// Fields of a struct from a ufunc's arguments and to its results, in the order of the struct's list; with the names and
// the number of the fields.
#define NAME_OF(name, unit) #name " "
#define ONE(name, unit) +1
#define READ(name, unit) to->name = *reinterpret_cast<const double*>(*args++ + i * *steps++);
#define WRITE(name, unit) *reinterpret_cast<double*>(*args++ + i * *steps++) = from.name;
#define COUNT(LIST) (0 LIST(ONE))
#define READER(type, LIST) \
  inline void read(type* to, char** args, const npy_intp* steps, npy_intp i) { LIST(READ) } \
  static_assert(sizeof(type) == COUNT(LIST) * sizeof(double), #type " has the fields of " #LIST);
#define WRITER(type, LIST) \
  inline void write(const type& from, char** args, const npy_intp* steps, npy_intp i) { LIST(WRITE) } \
  static_assert(sizeof(type) == COUNT(LIST) * sizeof(double), #type " has the fields of " #LIST);
READER(trum_balance, TRUM_HALF_ANGLE_IN)
READER(trum_brush_in, TRUM_BRUSH_IN)
READER(trum_brush_speed_in, TRUM_BRUSH_SPEED_IN)
READER(trum_coupled_lap_in, TRUM_COUPLED_LAP_IN)
WRITER(trum_coupled_lap_out, TRUM_COUPLED_LAP_OUT)
READER(trum_cycle_sums_in, TRUM_CYCLE_SUMS_IN)
WRITER(trum_cycle_sums_out, TRUM_CYCLE_SUMS_OUT)
READER(trum_cycle_response_in, TRUM_CYCLE_RESPONSE_IN)
WRITER(trum_cycle_response_out, TRUM_CYCLE_RESPONSE_OUT)
READER(trum_orbit_in, TRUM_ORBIT_IN)
WRITER(trum_orbit_out, TRUM_ORBIT_OUT)
READER(trum_slopes_in, TRUM_SLOPES_IN)
inline void read_orbit(trum_orbit_out* to, char** args, const npy_intp* steps, npy_intp i) { TRUM_HISTORY_IN(READ) }

// The signature of a generalised ufunc: n scalars.
std::string scalars(int n) {
  std::string text;
  for (int k = 0; k < n; ++k) text += k ? ",()" : "()";
  return text;
}

// Points that a loop takes at a time, on the heap: a thread's stack may be 128 KiB (musl).
npy_intp block(npy_intp most, const npy_intp* dimensions) { return std::max<npy_intp>(1, std::min(most, dimensions[0])); }

constexpr int n_half_angle_in = COUNT(TRUM_HALF_ANGLE_IN);
void half_angle_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    trum_balance b;
    read(&b, args, steps, i);
    *reinterpret_cast<double*>(args[n_half_angle_in] + i * steps[n_half_angle_in]) =
        trum_half_angle(b.F_c, b.k_N, b.W, b.k_c, b.n_j);
  }
}

// Friction of a brush at a speed, and the speed at a friction with what rounding does to it.
constexpr int n_brush_in = COUNT(TRUM_BRUSH_IN), n_brush_speed_in = COUNT(TRUM_BRUSH_SPEED_IN);
void brush_friction_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    trum_brush_in in;
    read(&in, args, steps, i);
    *reinterpret_cast<double*>(args[n_brush_in] + i * steps[n_brush_in]) =
        trum_brush_friction(in.theta, in.grip, in.ratio);
    *reinterpret_cast<double*>(args[n_brush_in + 1] + i * steps[n_brush_in + 1]) = trum_brush_rounding(in.grip);
  }
}
void brush_speed_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    trum_brush_speed_in in;
    read(&in, args, steps, i);
    const double ratio = trum_brush_speed(in.theta, in.grip, in.f);
    const double error = trum_brush_speed_error(in.theta, in.grip, in.f, ratio);
    *reinterpret_cast<double*>(args[n_brush_speed_in] + i * steps[n_brush_speed_in]) = ratio;
    *reinterpret_cast<double*>(args[n_brush_speed_in + 1] + i * steps[n_brush_speed_in + 1]) = error;
  }
}

constexpr int n_response_in = COUNT(TRUM_CYCLE_RESPONSE_IN);
void cycle_response_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    trum_cycle_response_in in;
    trum_cycle cycle = {};
    read(&in, args, steps, i);
    cycle.constants = {in.omega_n, in.Delta_omega, in.xi, in.psi, in.s, in.m, in.n, in.W, in.D, in.k_c};
    cycle.before = {in.a_A, in.b_A, in.a_B, in.b_B};
    trum_cycle_regions(&cycle);
    double tau = in.t;
    int region = 0;
    while (region < TRUM_REGIONS - 1 && tau >= cycle.duration[region]) tau -= cycle.duration[region++];
    trum_cycle_enter(&cycle, region);
    trum_cycle_at(&cycle, tau);
    write(trum_cycle_response_out{cycle.at.w_A, cycle.at.w_B, cycle.at.v_A, cycle.at.v_B, cycle.at.Q},
          args + n_response_in, steps + n_response_in, i);
  }
}

const trum::OrbitCode* orbit_code = &trum::orbit_baseline;

// The grid of the same instruction set.
const trum::GridCode& grid_code() {
#if defined(TRUM_X86_ORBITS)
  if (orbit_code == &trum::orbit_avx2) return trum::grid_avx2;
  if (orbit_code == &trum::orbit_avx512) return trum::grid_avx512;
#endif
  return trum::grid_baseline;
}

trum::CoupledLap coupled_code() {
#if defined(TRUM_X86_ORBITS)
  if (orbit_code == &trum::orbit_avx2) return trum::coupled_avx2;
  if (orbit_code == &trum::orbit_avx512) return trum::coupled_avx512;
#endif
  return trum::coupled_baseline;
}

constexpr int n_coupled_in = COUNT(TRUM_COUPLED_LAP_IN), n_coupled_out = COUNT(TRUM_COUPLED_LAP_OUT);
void coupled_lap_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    trum_coupled_lap_in in;
    trum_coupled_lap_out out;
    read(&in, args, steps, i);
    coupled_code()(&in, &out, nullptr);
    write(out, args + n_coupled_in, steps + n_coupled_in, i);
  }
}

// The same with the slopes of the end state and of the mean speed, a matrix of these by the state at the start.
void coupled_slopes_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  const npy_intp* core = steps + n_coupled_in + n_coupled_out + 1;  // strides of rows and columns
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    trum_coupled_lap_in in;
    trum_coupled_lap_out out;
    double slopes[trum::coupled_rows][trum::coupled_columns];
    read(&in, args, steps, i);
    coupled_code()(&in, &out, slopes[0]);
    write(out, args + n_coupled_in, steps + n_coupled_in, i);
    char* to = args[n_coupled_in + n_coupled_out] + i * steps[n_coupled_in + n_coupled_out];
    for (int of = 0; of < trum::coupled_rows; ++of)
      for (int by = 0; by < trum::coupled_columns; ++by)
        *reinterpret_cast<double*>(to + of * core[0] + by * core[1]) = slopes[of][by];
  }
}

template <class T>
T& at(std::vector<T>& of, npy_intp place) {
  return of[static_cast<std::size_t>(place)];
}

// Blocks of points of one contact law, small enough to keep their inputs in cache.
constexpr int n_orbit_in = COUNT(TRUM_ORBIT_IN), n_orbit_out = COUNT(TRUM_ORBIT_OUT);
template <class Orbits>
void orbit_blocks(char** args, const npy_intp* dimensions, const npy_intp* steps, Orbits orbits) {
  const Unlocked unlocked;
  const npy_intp most = block(256, dimensions);
  std::vector<trum_orbit_in> in(static_cast<std::size_t>(most));
  std::vector<trum_orbit_out> out(static_cast<std::size_t>(most));
  for (npy_intp i = 0; i < dimensions[0];) {
    npy_intp count = 0;
    for (; i + count < dimensions[0] && count < most; ++count) {
      read(&at(in, count), args, steps, i + count);
      if ((at(in, count).hertz > 0.5) != (at(in, 0).hertz > 0.5)) break;
    }
    orbits(in.data(), out.data(), static_cast<long>(count));
    for (npy_intp k = 0; k < count; ++k) write(at(out, k), args + n_orbit_in, steps + n_orbit_in, i + k);
    i += count;
  }
}
void rotor_orbit_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  orbit_blocks(args, dimensions, steps, [](const trum_orbit_in* in, trum_orbit_out* out, long count) {
    orbit_code->orbits(in, out, nullptr, nullptr, count);
  });
}
void rotor_grid_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  orbit_blocks(args, dimensions, steps, grid_code().orbits);
}

constexpr int n_sums_in = COUNT(TRUM_CYCLE_SUMS_IN);
void cycle_sums_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  const npy_intp most = block(512, dimensions);
  std::vector<trum_cycle_sums_in> in(static_cast<std::size_t>(most));
  std::vector<trum_cycle_sums_out> out(static_cast<std::size_t>(most));
  for (npy_intp i = 0; i < dimensions[0]; i += most) {
    const npy_intp count = std::min(most, dimensions[0] - i);
    for (npy_intp k = 0; k < count; ++k) read(&at(in, k), args, steps, i + k);
    orbit_code->sums(in.data(), out.data(), static_cast<long>(count));
    for (npy_intp k = 0; k < count; ++k) write(at(out, k), args + n_sums_in, steps + n_sums_in, i + k);
  }
}

// The same with the slopes of the figures, a matrix of figures by what they depend on.
constexpr int n_slopes_in = n_orbit_in + COUNT(TRUM_SLOPES_IN), n_slopes_out = n_orbit_out + 1;
void rotor_slopes_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  const npy_intp most = block(64, dimensions);
  std::vector<trum_orbit_in> in(static_cast<std::size_t>(most));
  std::vector<trum_slopes_in> with(static_cast<std::size_t>(most));
  std::vector<trum_orbit_out> out(static_cast<std::size_t>(most));
  std::vector<trum_slopes_out> slopes(static_cast<std::size_t>(most));
  const npy_intp* core = steps + n_slopes_in + n_slopes_out;  // strides of rows and columns
  for (npy_intp i = 0; i < dimensions[0];) {
    npy_intp count = 0;
    for (; i + count < dimensions[0] && count < most; ++count) {
      read(&at(in, count), args, steps, i + count);
      read(&at(with, count), args + n_orbit_in, steps + n_orbit_in, i + count);
      if ((at(in, count).hertz > 0.5) != (at(in, 0).hertz > 0.5)) break;
    }
    orbit_code->orbits(in.data(), out.data(), with.data(), slopes.data(), static_cast<long>(count));
    for (npy_intp k = 0; k < count; ++k) {
      write(at(out, k), args + n_slopes_in, steps + n_slopes_in, i + k);
      char* to = args[n_slopes_in + n_orbit_out] + (i + k) * steps[n_slopes_in + n_orbit_out];
      for (int of = 0; of < TRUM_SLOPE_FIGURES_COUNT; ++of)
        for (int by = 0; by < TRUM_SLOPE_PARAMETERS_COUNT; ++by)
          *reinterpret_cast<double*>(to + of * core[0] + by * core[1]) = at(slopes, k).of[of][by];
    }
    i += count;
  }
}

// Core dimension k: equal times of a cycle; `times` only gives their number.
constexpr int n_history_in = n_orbit_in + COUNT(TRUM_HISTORY_IN) + 1, n_history_out = 2;
void rotor_history_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  const npy_intp k = dimensions[1];
  const npy_intp* core = steps + n_history_in + n_history_out;  // strides of times, speed, distance
  std::vector<double> held(static_cast<std::size_t>(n_history_out * k));
  double* const out = held.data();
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    trum_orbit_in point;
    trum_orbit_out orbit = {};
    read(&point, args, steps, i);
    read_orbit(&orbit, args + n_orbit_in, steps + n_orbit_in, i);
    orbit_code->history(&point, &orbit, out, out + k, k);
    for (int o = 0; o < n_history_out; ++o) {
      char* to = args[n_history_in + o] + i * steps[n_history_in + o];
      for (npy_intp j = 0; j < k; ++j) *reinterpret_cast<double*>(to + j * core[1 + o]) = out[o * k + j];
    }
  }
}

// Which instruction set the orbits run on: the best that this CPU has, until a test asks for another.  TRUM_X86_ORBITS:
// whether the build has made the copies for AVX2 and AVX-512.
bool supported(const trum::OrbitCode& code) {
#if defined(TRUM_X86_ORBITS)
  static const trum::Cpu cpu = trum::this_cpu();
  if (&code == &trum::orbit_avx2) return cpu.avx2;
  if (&code == &trum::orbit_avx512) return cpu.avx512;
#endif
  return &code == &trum::orbit_baseline;
}
constexpr const trum::OrbitCode* orbit_codes[] = {
    &trum::orbit_baseline,
#if defined(TRUM_X86_ORBITS)
    &trum::orbit_avx2, &trum::orbit_avx512,
#endif
};

PyObject* use(PyObject*, PyObject* name) {
  const char* wanted = PyUnicode_AsUTF8AndSize(name, nullptr);
  if (wanted == nullptr) return nullptr;
  for (const trum::OrbitCode* code : orbit_codes)
    if (std::strcmp(code->name, wanted) == 0 && supported(*code)) {
      orbit_code = code;
      Py_RETURN_NONE;
    }
  return PyErr_Format(PyExc_ValueError, "%s is not an instruction set of this CPU", wanted);
}

PyObject* instruction_sets(PyObject*, PyObject*) {
  PyObject* found = PyDict_New();
  for (const trum::OrbitCode* code : orbit_codes) {
    if (found == nullptr || !supported(*code)) continue;
    PyObject* lanes = PyLong_FromLong(code->lanes);
    if (lanes == nullptr || PyDict_SetItemString(found, code->name, lanes) < 0) Py_CLEAR(found);
    Py_XDECREF(lanes);
  }
  return found;
}

// In the order of orbit.inc.
constexpr const char* step_operations[] = {"step", "add", "mul", "div", "sqrt", "fmin", "lt", "fabs", "sin", "cos", "atan2", "cbrt"};

PyObject* step_benchmark(PyObject*, PyObject* args) {
  const char* name;
  long count;
  if (!PyArg_ParseTuple(args, "sl", &name, &count)) return nullptr;
  for (int k = 0; k < static_cast<int>(std::size(step_operations)); ++k)
    if (std::strcmp(step_operations[k], name) == 0) return PyFloat_FromDouble(orbit_code->steps(k, count));
  return PyErr_Format(PyExc_ValueError, "%s is not an operation of a step", name);
}

PyMethodDef methods[] = {
    {"step_benchmark", step_benchmark, METH_VARARGS, "Repeat a step of wave, contact and friction, or an operation of it."},
    {"use", use, METH_O, "Run the orbits on an instruction set of instruction_sets()."},
    {"instruction_sets", instruction_sets, METH_NOARGS, "The sets that this CPU has, slowest first, with their lanes."},
    {nullptr, nullptr, 0, nullptr}};

constexpr int max_args = 64;
char types[max_args];
void* no_data[1] = {nullptr};

bool add(PyObject* module, PyObject* signatures, const char* name, PyUFuncGenericFunction* loop, int n_in, int n_out,
         const char* inputs, const char* outputs, const char* core = nullptr) {
  PyObject* ufunc = PyUFunc_FromFuncAndDataAndSignature(loop, no_data, types, 1, n_in, n_out, PyUFunc_None, name,
                                                        outputs, 0, core);
  if (ufunc == nullptr || PyModule_AddObject(module, name, ufunc) < 0) {
    Py_XDECREF(ufunc);
    return false;
  }
  PyObject* pair = Py_BuildValue("(ss)", inputs, outputs);
  const bool stored = pair != nullptr && PyDict_SetItemString(signatures, name, pair) == 0;
  Py_XDECREF(pair);
  return stored;
}

#define LOOP(name, n_in, n_out, inputs, outputs) \
  PyUFuncGenericFunction loop_##name[1] = {kernel_loop<name, n_in, n_out>};
TRUM_KERNELS(LOOP)
#undef LOOP
PyUFuncGenericFunction loop_half_angle[1] = {half_angle_loop};
PyUFuncGenericFunction loop_brush_friction[1] = {brush_friction_loop};
PyUFuncGenericFunction loop_brush_speed[1] = {brush_speed_loop};
PyUFuncGenericFunction loop_coupled_lap[1] = {coupled_lap_loop};
PyUFuncGenericFunction loop_coupled_slopes[1] = {coupled_slopes_loop};
PyUFuncGenericFunction loop_cycle_sums[1] = {cycle_sums_loop};
PyUFuncGenericFunction loop_cycle_response[1] = {cycle_response_loop};
PyUFuncGenericFunction loop_rotor_orbit[1] = {rotor_orbit_loop};
PyUFuncGenericFunction loop_rotor_grid[1] = {rotor_grid_loop};
PyUFuncGenericFunction loop_rotor_slopes[1] = {rotor_slopes_loop};
PyUFuncGenericFunction loop_rotor_history[1] = {rotor_history_loop};

bool add_contacts(PyObject* module, PyObject* signatures) {
  const std::string slopes = scalars(n_coupled_in) + "->" + scalars(n_coupled_out) + ",(" +
                             std::to_string(trum::coupled_rows) + "," + std::to_string(trum::coupled_columns) + ")";
  return add(module, signatures, "brush_friction", loop_brush_friction, n_brush_in, 2, TRUM_BRUSH_IN(NAME_OF), "f f_error") &&
         add(module, signatures, "brush_speed", loop_brush_speed, n_brush_speed_in, 2, TRUM_BRUSH_SPEED_IN(NAME_OF),
             "ratio ratio_error") &&
         add(module, signatures, "coupled_lap", loop_coupled_lap, n_coupled_in, n_coupled_out,
             TRUM_COUPLED_LAP_IN(NAME_OF), TRUM_COUPLED_LAP_OUT(NAME_OF)) &&
         add(module, signatures, "coupled_slopes", loop_coupled_slopes, n_coupled_in, n_coupled_out + 1,
             TRUM_COUPLED_LAP_IN(NAME_OF), TRUM_COUPLED_LAP_OUT(NAME_OF) "slopes", slopes.c_str());
}

#ifndef TRUM_MADE_OF  // the digest of the sources, which CMake knows
#define TRUM_MADE_OF ""
#endif

PyModuleDef definition = {PyModuleDef_HEAD_INIT, "_kernels", "Compiled kernels as NumPy ufuncs.", -1,
                          methods, nullptr, nullptr, nullptr, nullptr};

}  // namespace

PyMODINIT_FUNC PyInit__kernels() {
  import_array();
  import_umath();
  for (char& type : types) type = NPY_DOUBLE;
  PyObject* module = PyModule_Create(&definition);
  PyObject* signatures = PyDict_New();
  if (module == nullptr || signatures == nullptr) return nullptr;
#ifdef Py_GIL_DISABLED
  // The loops share nothing that is written but which instruction set the orbits run on, which `use` sets for tests;
  // but no interpreter without the lock has run the tests yet, so the lock stays on.
  PyUnstable_Module_SetGIL(module, Py_MOD_GIL_USED);
#endif
#define ADD(name, n_in, n_out, inputs, outputs) \
  if (!add(module, signatures, #name, loop_##name, n_in, n_out, inputs, outputs)) return nullptr;
  TRUM_KERNELS(ADD)
#undef ADD
  const std::string slopes = scalars(n_slopes_in) + "->" + scalars(n_orbit_out) + ",(" +
                             std::to_string(TRUM_SLOPE_FIGURES_COUNT) + "," +
                             std::to_string(TRUM_SLOPE_PARAMETERS_COUNT) + ")";
  const std::string history = scalars(n_history_in - 1) + ",(k)->(k),(k)";
  if (!add(module, signatures, "contact_half_angle", loop_half_angle, n_half_angle_in, 1, TRUM_HALF_ANGLE_IN(NAME_OF),
           "theta") ||
      !add_contacts(module, signatures) ||
      !add(module, signatures, "cycle_sums", loop_cycle_sums, n_sums_in, COUNT(TRUM_CYCLE_SUMS_OUT),
           TRUM_CYCLE_SUMS_IN(NAME_OF), TRUM_CYCLE_SUMS_OUT(NAME_OF)) ||
      !add(module, signatures, "cycle_response", loop_cycle_response, n_response_in, COUNT(TRUM_CYCLE_RESPONSE_OUT),
           TRUM_CYCLE_RESPONSE_IN(NAME_OF), TRUM_CYCLE_RESPONSE_OUT(NAME_OF)) ||
      !add(module, signatures, "rotor_orbit", loop_rotor_orbit, n_orbit_in, n_orbit_out, TRUM_ORBIT_IN(NAME_OF),
           TRUM_ORBIT_OUT(NAME_OF)) ||
      !add(module, signatures, "rotor_grid", loop_rotor_grid, n_orbit_in, n_orbit_out, TRUM_ORBIT_IN(NAME_OF),
           TRUM_ORBIT_OUT(NAME_OF)) ||
      !add(module, signatures, "rotor_slopes", loop_rotor_slopes, n_slopes_in, n_slopes_out,
           TRUM_ORBIT_IN(NAME_OF) TRUM_SLOPES_IN(NAME_OF), TRUM_ORBIT_OUT(NAME_OF) "slopes", slopes.c_str()) ||
      !add(module, signatures, "rotor_history", loop_rotor_history, n_history_in, n_history_out,
           TRUM_ORBIT_IN(NAME_OF) TRUM_HISTORY_IN(NAME_OF) "times", "speed distance", history.c_str()))
    return nullptr;
  if (PyModule_AddStringConstant(module, "slope_figures", TRUM_SLOPE_FIGURES(NAME_OF)) < 0 ||
      PyModule_AddStringConstant(module, "slope_parameters", TRUM_SLOPE_PARAMETERS(NAME_OF)) < 0 ||
      PyModule_AddStringConstant(module, "orbit_flags", TRUM_ORBIT_FLAGS) < 0 ||
      PyModule_AddStringConstant(module, "made_of", TRUM_MADE_OF) < 0)
    return nullptr;
  for (const trum::OrbitCode* code : orbit_codes)
    if (supported(*code)) orbit_code = code;
  if (PyModule_AddObject(module, "signatures", signatures) < 0) return nullptr;
  return module;
}
