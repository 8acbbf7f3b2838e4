// The determinant's sums over lanes of points: trum_cycle.h's panels, one in each lane, samples at once.  A panel in
// which Q changes sign, or may, is summed alone, by trum_cycle.h.  Included by orbit.inc, after the lanes' kernels.

struct Walk {  // of one point through its cycle
  trum_cycle cycle;
  trum_sums sums;
  double panels, index, count, from, to;
  int region;
  long point;  // -1: none left
};

// The arguments of the lanes' response, in the kernel's order.
struct Samples {
  Lane arg[trum_response_n_arg], Q, rate;
  void at(Lane tau) {
    Lane unused[4];
    const Lane* from[trum_response_n_arg];
    Lane* to[trum_response_n_res];
    arg[trum_response_in_tau] = tau;
    for (int i = 0; i < trum_response_n_arg; ++i) from[i] = &arg[i];
    to[trum_response_out_w_A] = &unused[0], to[trum_response_out_w_B] = &unused[1];
    to[trum_response_out_v_A] = &unused[2], to[trum_response_out_v_B] = &unused[3];
    to[trum_response_out_Q] = &Q, to[trum_response_out_Q_rate] = &rate;
    lane::trum_response(from, to, nullptr, nullptr, 0);
  }
};

// Enters the next region that lasts, and puts what the response needs of it into the lane; false at the cycle's end.
inline bool enter_region(Walk* w, Samples* s, int i) {
  trum_cycle& c = w->cycle;
  do {
    if (++w->region == TRUM_REGIONS) return false;
    w->index = 0, w->count = trum_panel_count(&c, w->region, w->panels);
    if (!(c.duration[w->region] > 0)) continue;
    trum_cycle_enter(&c, w->region);
    trum_add_steady(&c, &w->sums, w->region);
  } while (!(w->count > 0));
  s->arg[trum_response_in_a_A].set(i, c.state.a_A), s->arg[trum_response_in_b_A].set(i, c.state.b_A);
  s->arg[trum_response_in_a_B].set(i, c.state.a_B), s->arg[trum_response_in_b_B].set(i, c.state.b_B);
  s->arg[trum_response_in_g_A].set(i, c.gates.g_A), s->arg[trum_response_in_g_B].set(i, c.gates.g_B);
  return true;
}

inline void cycle_sums(const trum_cycle_sums_in* in, trum_cycle_sums_out* out, long count) {
  static const double nodes[] = TRUM_GAUSS_NODES, weights[] = TRUM_GAUSS_WEIGHTS;
  Walk walks[LANES];
  Samples s;
  long next = 0, busy = 0;
  for (int k = 0; k < trum_response_n_arg; ++k) s.arg[k] = 1.0;  // an idle lane computes on numbers too

  auto load = [&](int i) {  // the next point that has a panel
    Walk& w = walks[i];
    for (;;) {
      w.point = next < count ? next++ : -1;
      if (w.point < 0) return;
      const trum_cycle_sums_in& v = in[w.point];
      w.cycle = {};
      w.cycle.constants = {v.omega_n, v.Delta_omega, v.xi, v.psi, v.s, v.m, v.n, 1.0, 1.0, 1.0};
      w.cycle.before = {v.a_A, v.b_A, v.a_B, v.b_B};
      w.sums = {0.0, 0.0, 0.0, 0.0}, w.panels = v.panels, w.region = -1;
      trum_cycle_regions(&w.cycle);
      s.arg[trum_response_in_omega_n].set(i, v.omega_n), s.arg[trum_response_in_Delta_omega].set(i, v.Delta_omega);
      s.arg[trum_response_in_xi].set(i, v.xi), s.arg[trum_response_in_psi].set(i, v.psi);
      s.arg[trum_response_in_s].set(i, v.s);
      if (enter_region(&w, &s, i)) break;
      out[w.point] = {w.sums.q_plus, w.sums.q_minus, w.sums.p_plus, w.sums.p_minus};
    }
    ++busy;
  };
  for (int i = 0; i < LANES; ++i) load(i);

  while (busy > 0) {
    Lane from = 0.0, to = 0.0, integral = 0.0, square = 0.0;
    for (int i = 0; i < LANES; ++i) {
      Walk& w = walks[i];
      if (w.point < 0) continue;
      const double length = trum_covered(&w.cycle, w.region);
      w.from = length * (w.index / w.count), w.to = length * ((w.index + 1) / w.count);
      from.set(i, w.from), to.set(i, w.to);
    }
    const Lane half = Lane(0.5) * (to - from), middle = Lane(0.5) * (to + from);
    Bits cut = {};
    s.at(from);
    Lane Q = s.Q, rate = s.rate, tau = from;
    for (int k = 0; k <= TRUM_GAUSS_POINTS; ++k) {
      const Lane here = k < TRUM_GAUSS_POINTS ? middle + half * Lane(nodes[k]) : to;
      s.at(here);
      if (k < TRUM_GAUSS_POINTS) {
        integral += Lane(weights[k]) * s.Q;
        square += Lane(weights[k]) * s.Q * s.Q;
      }
      // trum_may_dip, without its signs
      const Lane depth = Lane(2.0) * (here - tau) * fmax(fabs(rate), fabs(s.rate));
      cut |= ((Q.v >= 0.0) != (s.Q.v >= 0.0)) | (fmin(fabs(Q), fabs(s.Q)).v <= depth.v);
      Q = s.Q, rate = s.rate, tau = here;
    }
    for (int i = 0; i < LANES; ++i) {
      Walk& w = walks[i];
      if (w.point < 0) continue;
      if (cut[i]) {
        const trum_sample left = trum_sample_at(&w.cycle, w.from), right = trum_sample_at(&w.cycle, w.to);
        trum_panel(&w.cycle, &w.sums, &left, &right, w.from, w.to);
      } else {
        trum_add(&w.sums, half[i] * integral[i], half[i] * square[i]);
      }
      if (++w.index < w.count || enter_region(&w, &s, i)) continue;
      out[w.point] = {w.sums.q_plus, w.sums.q_minus, w.sums.p_plus, w.sums.p_minus};
      --busy;
      load(i);
    }
  }
}
