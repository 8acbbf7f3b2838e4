// Loops around the generated kernels: what one cycle's determinant sums to, where the load balances.
// Formulas live in the generated C; here are only root finding, quadrature and bookkeeping.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "trum_kernels.h"
#include "trum_quadrature.h"

namespace trum {

// Newton on a bracketed root, with bisection whenever Newton leaves the bracket or stalls.
// f(x) returns {value, slope}.  Zero counts as positive, so f(low) = 0 < f's later fall is no root yet;
// f(low) and f(high) have different signs in that sense.
template <class F>
double bracketed_root(const F& f, double low, double high) {
  const bool rising = f(low).first < 0.0;
  const double smallest = 1e-16 * (high - low);
  double x = 0.5 * (low + high), width_before = high - low;
  for (int i = 0; i < 200; ++i) {
    const auto [value, slope] = f(x);
    ((value < 0.0) == rising ? low : high) = x;
    const double width = high - low;
    double next = x - value / slope;
    const bool usable = next > low && next < high && (i % 3 != 2 || width < 0.5 * width_before);
    if (i % 3 == 2) width_before = width;
    if (!usable) next = 0.5 * (low + high);
    if (width <= smallest || std::abs(next - x) <= 2e-16 * std::abs(next)) return next;
    x = next;
  }
  return x;
}

// Half-angle in (0, pi] at which the Winkler layer carries the prepressure; pi: the whole wave is in contact.
inline double contact_half_angle(double F_c, double k_N, double W, double k_c, double n_j) {
  double theta = 0.0, residual = 0.0, slope = 0.0;
  const double* arg[trum_winkler_balance_n_arg];
  double* res[trum_winkler_balance_n_res];
  arg[trum_winkler_balance_in_F_c] = &F_c;
  arg[trum_winkler_balance_in_W] = &W;
  arg[trum_winkler_balance_in_k_N] = &k_N;
  arg[trum_winkler_balance_in_k_c] = &k_c;
  arg[trum_winkler_balance_in_n_j] = &n_j;
  arg[trum_winkler_balance_in_theta] = &theta;
  res[trum_winkler_balance_out_residual] = &residual;
  res[trum_winkler_balance_out_slope] = &slope;
  const auto balance = [&](double at) {
    theta = at;
    trum_winkler_balance(arg, res, nullptr, nullptr, 0);
    return std::pair<double, double>(residual, slope);
  };
  const double pi = 3.14159265358979323846;
  if (!(balance(pi).first < 0.0)) return F_c == F_c && W == W ? pi : F_c + W;
  return bracketed_root(balance, 0.0, pi);
}

// One drive cycle of unit amplitude: what the determinant needs to be evaluated anywhere in it.
class Cycle {
 public:
  double omega_n, Delta_omega, xi, psi, s, m, n;
  double W = 1.0, D = 1.0, k_c = 1.0;
  double duration[TRUM_REGIONS];
  double w_A, w_B, v_A, v_B, Q, Q_rate;  // filled by at()

  Cycle(double omega_n_, double Delta_omega_, double xi_, double psi_, double s_, double m_, double n_,
        double a_A, double b_A, double a_B, double b_B, double W_, double D_, double k_c_)
      : omega_n(omega_n_), Delta_omega(Delta_omega_), xi(xi_), psi(psi_), s(s_), m(m_), n(n_),
        W(W_), D(D_), k_c(k_c_) {
    regions(a_A, b_A, a_B, b_B);
    connect();
  }
  Cycle(const Cycle&) = delete;
  Cycle& operator=(const Cycle&) = delete;

  void enter(int region) {
    static constexpr double gates_A[] = TRUM_GATES_A, gates_B[] = TRUM_GATES_B;
    for (int i = 0; i < 4; ++i) state_[i] = start_[4 * region + i];
    g_A_ = gates_A[region];
    g_B_ = gates_B[region];
  }

  // Both phases and the determinant, tau after the start of the region entered last.
  void at(double tau) {
    tau_ = tau;
    trum_response(arg_, res_, nullptr, nullptr, 0);
  }

 private:
  double start_[4 * TRUM_REGIONS];
  double state_[4], g_A_ = 0.0, g_B_ = 0.0, tau_ = 0.0;
  const double* arg_[trum_response_n_arg];
  double* res_[trum_response_n_res];

  void regions(double a_A, double b_A, double a_B, double b_B) {
    const double* arg[trum_regions_n_arg];
    double out[trum_regions_n_res];
    double* res[trum_regions_n_res];
    for (int i = 0; i < trum_regions_n_res; ++i) res[i] = &out[i];
    arg[trum_regions_in_Delta_omega] = &Delta_omega;
    arg[trum_regions_in_W] = &W;
    arg[trum_regions_in_a_A] = &a_A;
    arg[trum_regions_in_a_B] = &a_B;
    arg[trum_regions_in_b_A] = &b_A;
    arg[trum_regions_in_b_B] = &b_B;
    arg[trum_regions_in_m] = &m;
    arg[trum_regions_in_n] = &n;
    arg[trum_regions_in_omega_n] = &omega_n;
    arg[trum_regions_in_psi] = &psi;
    arg[trum_regions_in_s] = &s;
    arg[trum_regions_in_xi] = &xi;
    trum_regions(arg, res, nullptr, nullptr, 0);
    for (int r = 0; r < TRUM_REGIONS; ++r) duration[r] = out[trum_regions_out_time_redu + r];
    for (int i = 0; i < 4 * TRUM_REGIONS; ++i) start_[i] = out[trum_regions_out_a_A_redu + i];
  }

  void connect() {
    arg_[trum_response_in_D] = &D;
    arg_[trum_response_in_Delta_omega] = &Delta_omega;
    arg_[trum_response_in_W] = &W;
    arg_[trum_response_in_a_A] = &state_[0];
    arg_[trum_response_in_b_A] = &state_[1];
    arg_[trum_response_in_a_B] = &state_[2];
    arg_[trum_response_in_b_B] = &state_[3];
    arg_[trum_response_in_g_A] = &g_A_;
    arg_[trum_response_in_g_B] = &g_B_;
    arg_[trum_response_in_k_c] = &k_c;
    arg_[trum_response_in_omega_n] = &omega_n;
    arg_[trum_response_in_psi] = &psi;
    arg_[trum_response_in_s] = &s;
    arg_[trum_response_in_tau] = &tau_;
    arg_[trum_response_in_xi] = &xi;
    res_[trum_response_out_w_A] = &w_A;
    res_[trum_response_out_w_B] = &w_B;
    res_[trum_response_out_v_A] = &v_A;
    res_[trum_response_out_v_B] = &v_B;
    res_[trum_response_out_Q] = &Q;
    res_[trum_response_out_Q_rate] = &Q_rate;
  }
};

// Integrals over a cycle of Q's positive part, of its negative part's magnitude, and of their squares.
struct Sums {
  double q_plus = 0.0, q_minus = 0.0, p_plus = 0.0, p_minus = 0.0;
};

// Gauss-Legendre on panels short against the fastest oscillation of Q; a panel in which Q changes sign is
// cut at the crossing, so that each piece is smooth and of one sign.
class SignedQuadrature {
 public:
  SignedQuadrature(Cycle& cycle, double panels_per_period) : cycle_(cycle), per_period_(panels_per_period) {}

  Sums run() {
    for (int region = 0; region < TRUM_REGIONS; ++region) {
      const double length = cycle_.duration[region];
      if (!(length > 0.0)) continue;
      cycle_.enter(region);
      const double fastest = std::max(cycle_.omega_n, cycle_.omega_n + cycle_.Delta_omega);
      const double count = std::ceil(per_period_ * length * fastest / 6.283185307179586 - 1e-9);
      Sample left = sample(0.0);
      for (double i = 0.0; i < count; ++i) {
        const double from = length * (i / count), to = length * ((i + 1.0) / count);
        const Sample right = sample(to);
        panel(left, right, from, to);
        left = right;
      }
    }
    return sums_;
  }

 private:
  static constexpr int points_ = TRUM_GAUSS_POINTS;
  static constexpr double nodes_[points_] = TRUM_GAUSS_NODES;
  static constexpr double weights_[points_] = TRUM_GAUSS_WEIGHTS;
  struct Sample {
    double tau, Q, rate;
  };
  Cycle& cycle_;
  double per_period_;
  Sums sums_;

  Sample sample(double tau) {
    cycle_.at(tau);
    return {tau, cycle_.Q, cycle_.Q_rate};
  }

  void add(double integral, double square) {
    if (integral >= 0.0) {
      sums_.q_plus += integral;
      sums_.p_plus += square;
    } else {
      sums_.q_minus -= integral;
      sums_.p_minus += square;
    }
  }

  void piece(double from, double to) {
    if (!(to > from)) return;
    const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
    double integral = 0.0, square = 0.0;
    for (int i = 0; i < points_; ++i) {
      const double Q = sample(middle + half * nodes_[i]).Q;
      integral += weights_[i] * Q;
      square += weights_[i] * Q * Q;
    }
    add(half * integral, half * square);
  }

  double crossing(double low, double high) {
    return bracketed_root([&](double tau) {
      const Sample here = sample(tau);
      return std::pair<double, double>(here.Q, here.rate);
    }, low, high);
  }

  // The extremum between two samples, by bisection on the rate; exact enough to see Q's sign there.
  Sample extremum(const Sample& p, const Sample& q) {
    double low = p.tau, high = q.tau;
    Sample here = p;
    for (int i = 0; i < 40; ++i) {
      here = sample(0.5 * (low + high));
      if ((here.Q >= 0.0) != (p.Q >= 0.0)) break;
      ((here.rate < 0.0) == (p.rate < 0.0) ? low : high) = here.tau;
    }
    return here;
  }

  // Zero counts as positive, as in the sign changes: a phase at rest starts a region with Q = 0.
  static bool towards_zero(const Sample& p) { return p.Q >= 0.0 ? p.rate < 0.0 : p.rate > 0.0; }

  void panel(const Sample& left, const Sample& right, double from, double to) {
    const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
    Sample s[points_ + 2];
    s[0] = left;
    s[points_ + 1] = right;
    double integral = 0.0, square = 0.0;
    for (int i = 0; i < points_; ++i) {
      s[i + 1] = sample(middle + half * nodes_[i]);
      integral += weights_[i] * s[i + 1].Q;
      square += weights_[i] * s[i + 1].Q * s[i + 1].Q;
    }
    double start = from;
    bool cut = false;
    for (int i = 0; i <= points_; ++i) {
      const Sample &p = s[i], &q = s[i + 1];
      if ((p.Q >= 0.0) != (q.Q >= 0.0)) {
        cut_at(crossing(p.tau, q.tau), start, cut);
      } else if (towards_zero(p) && !towards_zero(q)) {  // |Q| dips between the samples
        const Sample dip = extremum(p, q);
        if ((dip.Q >= 0.0) != (p.Q >= 0.0)) {
          cut_at(crossing(p.tau, dip.tau), start, cut);
          cut_at(crossing(dip.tau, q.tau), start, cut);
        }
      }
    }
    if (cut) {
      piece(start, to);
    } else {
      add(half * integral, half * square);
    }
  }

  void cut_at(double tau, double& start, bool& cut) {
    piece(start, tau);
    start = tau;
    cut = true;
  }
};

}  // namespace trum
