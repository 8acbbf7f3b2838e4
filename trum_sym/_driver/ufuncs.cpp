// The Python face of the generated kernels and of the cycle driver: NumPy ufuncs, which broadcast,
// take strides and release the GIL by themselves.
#include <Python.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <vector>

#include <numpy/arrayobject.h>
#include <numpy/ufuncobject.h>

#include "orbit.hpp"
#include "trum_cycle.h"

namespace {

using Kernel = int (*)(const double**, double**, long long int*, double*, int);

template <Kernel kernel, int n_in, int n_out>
void kernel_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const double* arg[n_in];
  double* res[n_out];
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    for (int j = 0; j < n_in; ++j) arg[j] = reinterpret_cast<const double*>(args[j] + i * steps[j]);
    for (int j = 0; j < n_out; ++j) res[j] = reinterpret_cast<double*>(args[n_in + j] + i * steps[n_in + j]);
    kernel(arg, res, nullptr, nullptr, 0);
  }
}

// Lets other threads of the interpreter run meanwhile.  NumPy may have done so already, or not: it keeps the lock in
// short loops, and in all loops of an iterator that it has not marked as free of Python.
class Unlocked {
 public:
  Unlocked() : state_(PyGILState_Check() ? PyEval_SaveThread() : nullptr) {}
  ~Unlocked() {
    if (state_ != nullptr) PyEval_RestoreThread(state_);
  }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

template <int n>
std::array<double, n> gather(char** args, const npy_intp* steps, npy_intp i) {
  std::array<double, n> values;
  for (int j = 0; j < n; ++j) values[j] = *reinterpret_cast<const double*>(args[j] + i * steps[j]);
  return values;
}

template <std::size_t n>
void scatter(const std::array<double, n>& values, char** args, const npy_intp* steps, npy_intp i) {
  for (std::size_t j = 0; j < n; ++j) *reinterpret_cast<double*>(args[j] + i * steps[j]) = values[j];
}

constexpr char half_angle_in[] = "F_c k_N W k_c n_j";
constexpr char half_angle_out[] = "theta";
void half_angle_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    const auto v = gather<5>(args, steps, i);
    scatter<1>({trum_half_angle(v[0], v[1], v[2], v[3], v[4])}, args + 5, steps + 5, i);
  }
}

constexpr char cycle_sums_in[] = "omega_n Delta_omega xi psi s m n a_A b_A a_B b_B panels";
constexpr char cycle_sums_out[] = "q_plus q_minus p_plus p_minus";
constexpr char cycle_response_in[] = "t omega_n Delta_omega xi psi s m n a_A b_A a_B b_B W D k_c";
constexpr char cycle_response_out[] = "w_A w_B v_A v_B Q";
void cycle_response_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    const auto v = gather<15>(args, steps, i);
    trum_cycle cycle = {v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9], v[10], v[11], v[12], v[13], v[14],
                        {}, {}, {}, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    trum_cycle_regions(&cycle);
    double tau = v[0];
    int region = 0;
    while (region < TRUM_REGIONS - 1 && tau >= cycle.duration[region]) tau -= cycle.duration[region++];
    trum_cycle_enter(&cycle, region);
    trum_cycle_at(&cycle, tau);
    scatter<5>({cycle.w_A, cycle.w_B, cycle.v_A, cycle.v_B, cycle.Q}, args + 15, steps + 15, i);
  }
}

constexpr char orbit_in[] =
    "omega_n Delta_omega xi psi s m n a_A b_A a_B b_B W D k_c engagement_per_height W_full hertz push drag tolerance held";
constexpr char orbit_out[] = "mean low high variance contact held start level error flags";
constexpr int n_orbit_in = 21, n_orbit_out = 10, hertz_in = 16;
const trum::OrbitCode* orbit_code = &trum::orbit_baseline;

// Blocks of points of one contact law, small enough to keep their inputs in cache.
void rotor_orbit_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  constexpr npy_intp most = 256;
  std::array<std::array<double, n_orbit_in>, most> in;
  std::array<std::array<double, n_orbit_out>, most> out;
  for (npy_intp i = 0; i < dimensions[0];) {
    npy_intp count = 0;
    for (; i + count < dimensions[0] && count < most; ++count) {
      in[count] = gather<n_orbit_in>(args, steps, i + count);
      if (in[count][hertz_in] != in[0][hertz_in]) break;
    }
    orbit_code->orbits(in[0].data(), out[0].data(), nullptr, nullptr, static_cast<long>(count));
    for (npy_intp k = 0; k < count; ++k) scatter(out[k], args + n_orbit_in, steps + n_orbit_in, i + k);
    i += count;
  }
}

void cycle_sums_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  constexpr npy_intp most = 512;
  std::array<std::array<double, 12>, most> in;
  std::array<std::array<double, 4>, most> out;
  for (npy_intp i = 0; i < dimensions[0]; i += most) {
    const npy_intp count = std::min(most, dimensions[0] - i);
    for (npy_intp k = 0; k < count; ++k) in[k] = gather<12>(args, steps, i + k);
    orbit_code->sums(in[0].data(), out[0].data(), static_cast<long>(count));
    for (npy_intp k = 0; k < count; ++k) scatter(out[k], args + 12, steps + 12, i + k);
  }
}

// The same with the slopes of the figures, a matrix of figures by what they depend on.
constexpr char slopes_in[] =
    "omega_n Delta_omega xi psi s m n a_A b_A a_B b_B W D k_c engagement_per_height W_full hertz push drag tolerance held "
    "a_A_omega_n b_A_omega_n a_B_omega_n b_B_omega_n a_A_Delta_omega b_A_Delta_omega a_B_Delta_omega b_B_Delta_omega";
constexpr char slopes_out[] = "mean low high variance contact held start level error flags slopes";
constexpr char slopes_signature[] =
    "(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),()->"
    "(),(),(),(),(),(),(),(),(),(),(6,6)";
constexpr int n_slopes_in = n_orbit_in + 8, n_slopes_out = n_orbit_out + 1, n_slopes = 36;
void rotor_slopes_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  constexpr npy_intp most = 64;
  std::array<std::array<double, n_orbit_in>, most> in;
  std::array<std::array<double, n_slopes_in - n_orbit_in>, most> with;
  std::array<std::array<double, n_orbit_out>, most> out;
  std::array<std::array<double, n_slopes>, most> slopes;
  const npy_intp* core = steps + n_slopes_in + n_slopes_out;  // strides of rows and columns
  for (npy_intp i = 0; i < dimensions[0];) {
    npy_intp count = 0;
    for (; i + count < dimensions[0] && count < most; ++count) {
      in[count] = gather<n_orbit_in>(args, steps, i + count);
      with[count] = gather<n_slopes_in - n_orbit_in>(args + n_orbit_in, steps + n_orbit_in, i + count);
      if (in[count][hertz_in] != in[0][hertz_in]) break;
    }
    orbit_code->orbits(in[0].data(), out[0].data(), with[0].data(), slopes[0].data(), static_cast<long>(count));
    for (npy_intp k = 0; k < count; ++k) {
      scatter(out[k], args + n_slopes_in, steps + n_slopes_in, i + k);
      char* to = args[n_slopes_in + n_orbit_out] + (i + k) * steps[n_slopes_in + n_orbit_out];
      for (int e = 0; e < n_slopes; ++e) *reinterpret_cast<double*>(to + e / 6 * core[0] + e % 6 * core[1]) = slopes[k][e];
    }
    i += count;
  }
}

// Core dimension k: equal times of a cycle; `times` only gives their number.
constexpr char history_in[] =
    "omega_n Delta_omega xi psi s m n a_A b_A a_B b_B W D k_c engagement_per_height W_full hertz push drag tolerance held "
    "low high start level times";
constexpr char history_out[] = "speed distance";
constexpr char history_signature[] =
    "(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(),(k)->(k),(k)";
constexpr int n_history_in = n_orbit_in + 5, n_history_out = 2;
void rotor_history_loop(char** args, const npy_intp* dimensions, const npy_intp* steps, void*) {
  const Unlocked unlocked;
  const npy_intp k = dimensions[1];
  const npy_intp* core = steps + n_history_in + n_history_out;  // strides of times, speed, distance
  std::vector<double> out(static_cast<std::size_t>(n_history_out * k));
  for (npy_intp i = 0; i < dimensions[0]; ++i) {
    const auto point = gather<n_orbit_in>(args, steps, i);
    const auto from = gather<4>(args + n_orbit_in, steps + n_orbit_in, i);
    const double orbit[n_orbit_out] = {0.0, from[0], from[1], 0.0, 0.0, 0.0, from[2], from[3], 0.0, 0.0};
    orbit_code->history(point.data(), orbit, out.data(), out.data() + k, k);
    for (int o = 0; o < n_history_out; ++o) {
      char* to = args[n_history_in + o] + i * steps[n_history_in + o];
      for (npy_intp j = 0; j < k; ++j) *reinterpret_cast<double*>(to + j * core[1 + o]) = out[o * k + j];
    }
  }
}

// Which instruction set the orbits run on: the best that this CPU has, until a test asks for another.
bool supported(const trum::OrbitCode& code) {
#if defined(__x86_64__)
  if (&code == &trum::orbit_avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (&code == &trum::orbit_avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#endif
  return true;
}
constexpr const trum::OrbitCode* orbit_codes[] = {
    &trum::orbit_baseline,
#if defined(__x86_64__)
    &trum::orbit_avx2, &trum::orbit_avx512,
#endif
};

PyObject* use(PyObject*, PyObject* name) {
  const char* wanted = PyUnicode_AsUTF8(name);
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
PyUFuncGenericFunction loop_cycle_sums[1] = {cycle_sums_loop};
PyUFuncGenericFunction loop_cycle_response[1] = {cycle_response_loop};
PyUFuncGenericFunction loop_rotor_orbit[1] = {rotor_orbit_loop};
PyUFuncGenericFunction loop_rotor_slopes[1] = {rotor_slopes_loop};
PyUFuncGenericFunction loop_rotor_history[1] = {rotor_history_loop};

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
#define ADD(name, n_in, n_out, inputs, outputs) \
  if (!add(module, signatures, #name, loop_##name, n_in, n_out, inputs, outputs)) return nullptr;
  TRUM_KERNELS(ADD)
#undef ADD
  if (!add(module, signatures, "contact_half_angle", loop_half_angle, 5, 1, half_angle_in, half_angle_out)) return nullptr;
  if (!add(module, signatures, "cycle_sums", loop_cycle_sums, 12, 4, cycle_sums_in, cycle_sums_out)) return nullptr;
  if (!add(module, signatures, "cycle_response", loop_cycle_response, 15, 5, cycle_response_in, cycle_response_out))
    return nullptr;
  if (!add(module, signatures, "rotor_orbit", loop_rotor_orbit, n_orbit_in, n_orbit_out, orbit_in, orbit_out))
    return nullptr;
  if (!add(module, signatures, "rotor_slopes", loop_rotor_slopes, n_slopes_in, n_slopes_out, slopes_in, slopes_out,
           slopes_signature))
    return nullptr;
  if (!add(module, signatures, "rotor_history", loop_rotor_history, n_history_in, n_history_out, history_in, history_out,
           history_signature))
    return nullptr;
  for (const trum::OrbitCode* code : orbit_codes)
    if (supported(*code)) orbit_code = code;
  if (PyModule_AddObject(module, "signatures", signatures) < 0) return nullptr;
  return module;
}
