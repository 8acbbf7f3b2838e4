"""Every symbol of the equations: its assumptions, SI unit, LaTeX, meaning and where the paper defines it.

Motor parameters take name and unit from :class:`trum_sym.inputs.motor.Motor`; the rest stands here, once.  Symbols that
only one derivation works with are made there.  ``CLASHES`` lists the letters that the paper uses for several things.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, fields

import sympy as sp

from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.units import Dimension, parse_unit

__all__ = ["CLASHES", "CONSTANTS", "NOMENCLATURE", "TINY", "SymbolEntry", "latex", "sym"]


@dataclass(frozen=True)
class SymbolEntry:
    """A symbol, or a function of its arguments, with its SI unit, meaning, LaTeX and where the paper defines it."""

    symbol: sp.Expr
    unit: str
    meaning: str
    latex: str
    where: str

    @property
    def dimension(self) -> Dimension:
        """The exponents of the SI base units."""
        return parse_unit(self.unit).dimension


# name, unit, kind (+ positive symbol, r real symbol, f function of the arguments given), LaTeX, where defined, meaning
_REST = r"""
t           | s        | r | t | Sect. 2 | time
x           | m        | r | x | Sect. 2 | position along the unrolled circumference
tau         | s        | r | \tau | ours | time since the start of a region of the drive cycle
E           | Pa       | + | E | eq. 2 | Young's modulus of the composite section (eq. 2)
rho         | kg/m^3   | + | \rho | eq. 2 | mean density of the composite section (eq. 2)
I_z         | m^4      | + | I_z | eq. 2 | second moment of area of the composite section (eq. 2)
G           | Pa       | + | G | eq. 2 | shear modulus of the composite section (eq. 2)
A           | m^2      | + | A | eq. 2 | area of the composite section
E_eq        | Pa       | + | E_{eq} | eq. 1 | Young's modulus of the toothed beam, reduced for its grooves
k_f         | N/m^2    | + | k_f | ours | stiffness per length of the foundation under the beam
k_tooth     | N/m^2    | + | k_{tooth} | ours | stiffness of the stator's teeth per length of the circumference
k_flange    | N/m^2    | + | k_{flange} | ours | stiffness of the rotor's flange under the wave's load, per length
grip        | 1        | + | \lambda_T | ours | tangential over normal stiffness of the contact, times D k_c / mu
ratio       | 1        | r | r_v | ours | speed of the rotor's rim over the greatest of the surface
u           | rad      | r | u | ours | place in the contact, as an angle of the wave from its crest
u_0         | rad      | r | u_0 | ours | where a bristle began to stick
t_0         | 1        | r | t_0 | ours | its shear stress there, over mu k_N W
k_dx        | N/m      | + | k_{dx} | eq. 5 | the paper's foundation stiffness (below eq. 5)
theta       | rad      | + | \vartheta | ours | contact half-angle k_c x_m
F_c         | N        | + | F_c | eq. 8 | prepressure
N_1         | N        | + | 1\,\mathrm{N} | ours | one newton, which makes the base of eq. 8's power a number
W           | m        | + | W | ours | amplitude of a phase's standing wave
omega_n     | rad/s    | + | \omega_n | eq. 6 | resonant angular frequency
omega_q     | rad/s    | + | \omega_q | eq. 7 | drive angular frequency
Delta_omega | rad/s    | r | \Delta\omega | eq. 14 | angular frequency difference, drive less resonance
beta        | 1/m      | + | \beta | ours | rotation per displacement of the Timoshenko mode
m           | 1        | + | m | Sect. 5.2.1 | drive pulses per cycle (periods)
n           | 1        | + | n | Sect. 5.2.1 | pulses each phase gets per cycle (on_periods)
psi         | rad      | r | \psi | ours | drive phase at which the phases are switched (switching_phase)
s           | 1        | r | s | ours | phase lead of B in quarter periods, +1 or -1
T           | s        | + | T_{Qall} | eq. 43 | duration of a drive cycle
a           | m        | r | a | ours | free displacement at the start
b           | m/s      | r | b | ours | free velocity at the start
a_A         | m        | r | a_A | ours | free displacement of phase A at the start of the region
b_A         | m/s      | r | b_A | ours | free velocity of phase A at the start of the region
a_B         | m        | r | a_B | ours | free displacement of phase B at the start of the region
b_B         | m/s      | r | b_B | ours | free velocity of phase B at the start of the region
g_A         | 1        | r | g_A | ours | gate of phase A, 1 on and 0 off
g_B         | 1        | r | g_B | ours | gate of phase B, 1 on and 0 off
q_plus      | 1        | + | \sum Q_q^+ | eq. 43 | integral of the positive part of the determinant, W = D k_c = 1
q_minus     | 1        | + | \sum\vert Q_q^-\vert  | eq. 43 | integral of the magnitude of its negative part
p_plus      | 1/s      | + | \sum\vert Q_q^+\vert ^2 | eq. 44 | integral of the square of the positive part
p_minus     | 1/s      | + | \sum\vert Q_q^-\vert ^2 | eq. 44 | integral of the square of the negative part
W_full      | m        | + | W_{full} | ours | wave height below which the whole wave touches
a_A_omega_n | m*s | r | \partial a_A/\partial \omega_n | ours | derivative of a_A by omega_n
a_A_Delta_omega | m*s | r | \partial a_A/\partial \Delta\omega | ours | derivative of a_A by Delta_omega
b_A_omega_n | m | r | \partial b_A/\partial \omega_n | ours | derivative of b_A by omega_n
b_A_Delta_omega | m | r | \partial b_A/\partial \Delta\omega | ours | derivative of b_A by Delta_omega
a_B_omega_n | m*s | r | \partial a_B/\partial \omega_n | ours | derivative of a_B by omega_n
a_B_Delta_omega | m*s | r | \partial a_B/\partial \Delta\omega | ours | derivative of a_B by Delta_omega
b_B_omega_n | m | r | \partial b_B/\partial \omega_n | ours | derivative of b_B by omega_n
b_B_Delta_omega | m | r | \partial b_B/\partial \Delta\omega | ours | derivative of b_B by Delta_omega
f_A_re_omega_n | m*s | r | \partial f_{A,re}/\partial \omega_n | ours | derivative of f_A_re by omega_n
f_A_re_Delta_omega | m*s | r | \partial f_{A,re}/\partial \Delta\omega | ours | derivative of f_A_re by Delta_omega
f_A_im_omega_n | m*s | r | \partial f_{A,im}/\partial \omega_n | ours | derivative of f_A_im by omega_n
f_A_im_Delta_omega | m*s | r | \partial f_{A,im}/\partial \Delta\omega | ours | derivative of f_A_im by Delta_omega
f_B_re_omega_n | m*s | r | \partial f_{B,re}/\partial \omega_n | ours | derivative of f_B_re by omega_n
f_B_re_Delta_omega | m*s | r | \partial f_{B,re}/\partial \Delta\omega | ours | derivative of f_B_re by Delta_omega
f_B_im_omega_n | m*s | r | \partial f_{B,im}/\partial \omega_n | ours | derivative of f_B_im by omega_n
f_B_im_Delta_omega | m*s | r | \partial f_{B,im}/\partial \Delta\omega | ours | derivative of f_B_im by Delta_omega
engagement_per_height | 1/m      | + | \epsilon' | ours | engagement over wave height
f_A_re      | m        | r | f_{A,re} | ours | phasor of phase A's motion at the start of a region, real part
f_A_im      | m        | r | f_{A,im} | ours | its imaginary part
f_B_re      | m        | r | f_{B,re} | ours | phasor of phase B's motion at the start of a region, real part
f_B_im      | m        | r | f_{B,im} | ours | its imaginary part
p_re        | 1        | r | p_{re} | ours | phasor of the drive at the start of a region, real part
p_im        | 1        | r | p_{im} | ours | its imaginary part
e_re        | 1        | r | e_{re} | ours | turn and decay of free motion since then, real part
e_im        | 1        | r | e_{im} | ours | its imaginary part
d_re        | 1        | r | d_{re} | ours | what the drive's turn since then exceeds that by, real part
d_im        | 1        | r | d_{im} | ours | its imaginary part
W_c         | m        | + | W_c | ours | height of the wave at its crest
engagement | 1 | + | \epsilon | ours | the layer's force at full wave over the prepressure, 2 n_j k_N W_c / (k_c F_c)
share       | 1        | r | \sigma_p | ours | constant part of the pressure's share per angle
sin_theta   | 1        | r | \sin\vartheta | ours | sine of the contact half-angle
fullness    | 1        | + | \tau_c | ours | how full the contact is, 1 when the whole wave touches
fullness_root | 1        | + | \tau_c^{1/3} | ours | its cube root
phi         | rad      | r | \varphi_v | ours | phase of the surface speed, from the crest
cos_phi     | 1        | r | \cos\varphi_v | ours | its cosine
sin_phi     | 1        | r | \sin\varphi_v | ours | its sine
R_v         | m/s      | + | R_v | ours | amplitude of the surface speed along the wave
f           | 1        | r | f | ours | net friction fraction, of mu F_c
v           | m/s      | r | v | ours | speed of the rotor's rim, omega r_c
v_rate      | m/s^2    | r | \dot v | ours | its rate
R_v_rate    | m/s^2    | r | \dot R_v | ours | rate of R_v
W_c_rate    | m/s      | r | \dot W_c | ours | rate of W_c
p_larger    | 1        | r | p_1 | ours | the larger pressure where the surface is as fast as the rotor, over its mean
p_smaller   | 1        | r | p_2 | ours | the smaller one
step        | s        | + | h_t | ours | length of a time step
T_load      | N*m      | r | T_{load} | eq. 38 | load torque
J_load      | kg*m^2   | + | J_{load} | ours | moment of inertia of what turns with the rotor: plate, coupling
r_s         | m        | + | r_s | ours | radius at which the string that bears a weight runs off the plate
g           | m/s^2    | + | g | ours | standard gravity
J_total     | kg*m^2   | + | J_{total} | ours | moment of inertia of all that turns or moves with the rotor
M_q         | kg       | + | M_q | ours | modal mass of a phase's standing wave on the whole ring
F_q         | N        | + | F_q | ours | modal force of a phase
Theta_q     | N/V      | + | \Theta_q | ours | force factor of a phase: modal force per volt, charge per displacement
C_0         | F        | + | C_0 | ours | capacitance of a phase whose stator is held still
lead        | rad      | r | \delta_q | ours | angle by which the modal force is ahead of the wave
height      | m        | r | y_r | ours | height of the layer's surface over that of a stator at rest
alpha       | rad      | + | \alpha | ours | half of the part of a contact whose surface is faster than the rotor
cos_theta   | 1        | r | \cos\vartheta | ours | cosine of the contact half-angle
sin_crest   | 1        | r | \sin k_c x_{max} | ours | sine of the crest's place as an angle of the wave
cos_crest   | 1        | r | \cos k_c x_{max} | ours | its cosine
central     | N        | r | R_q | ours | modal force of the pressure against the height of the wave
along       | N        | r | C_q | ours | friction's part in cos u over all crests, which holds the wave back
across      | N        | r | S_q | ours | friction's part in sin u over all crests, along the height of the wave
lossy       | N        | r | L_q | ours | the pressure's part in sin u over all crests, by which the layer takes power
leaving     | rad      | + | \vartheta_l | ours | angle from a lossy layer's greatest pressure back to its end
free        | rad      | + | \varphi_l | ours | angle by which the wave moves on while a lossy layer recovers freely
u_in        | rad      | r | u_{in} | ours | where a lossy layer meets the surface, from the crest
u_out       | rad      | r | u_{out} | ours | where it leaves
zone_low    | rad      | r | u_- | ours | end of the driving zone behind the crest
zone_high   | rad      | r | u_+ | ours | end of the driving zone ahead of the crest
sheared     | rad      | r | \Sigma_1 | ours | integral of the bristles' stress over mu k_N W along the contact
sheared_cos | 1        | r | \Sigma_c | ours | the same times cos u
sheared_sin | 1        | r | \Sigma_s | ours | the same times sin u
sheared_ratio | rad    | r | \Sigma_r | ours | rate of the first of these by the rotor's speed over the surface's
level       | 1        | r | y_l | ours | height of the layer's surface over that of a stator at rest, over W
v_A         | m/s      | r | \dot w_A | ours | velocity of phase A
v_B         | m/s      | r | \dot w_B | ours | velocity of phase B
"""

# The paper's symbols that only the ledger needs, in the order of the paper.
_PAPER = r"""
z           | m        | r | z | Sect. 2.1 | depth below the tooth surface or the neutral axis
k_t         | 1        | + | k_t | Sect. 2.1 | tooth height over beam height
k_s         | 1        | + | k_s | Sect. 2.1 | share of the grooves in the circumference
k_d         | 1        | + | k_d | Sect. 2.1 | share of the metal left by the grooves
rho_eq      | kg/m^3   | + | \rho_{eq} | Sect. 2.1 | density of the beam reduced for its grooves
G_eq        | Pa       | + | G_{eq} | Sect. 2.1 | shear modulus of the beam reduced for its grooves
A_eq        | m^2      | + | A_{eq} | Sect. 2.1 | area of the metal
A_p         | m^2      | + | A_p | Sect. 2.1 | area of the ceramic
I_e         | m^4      | + | I_e | eq. 2 | second moment of the metal about the neutral axis
I_p         | m^4      | + | I_p | eq. 2 | second moment of the ceramic about the neutral axis
h           | m        | + | h | eq. 2 | height of metal and ceramic
w           | m        | f x t | w | eq. 3 | vertical displacement of the beam, printed omega
p           | N/m      | f x t | p | eq. 3 | load per length of the beam
omega_n0    | rad/s    | + | \omega_{n0} | eq. 4 | natural frequency without prepressure
x_m         | m        | + | x_m | eq. 5 | half-length of a contact
k_ds        | N/m      | + | k_{ds} | eq. 5 | printed stiffness of the foundation
a_1         | N*m^2    | + | a_1 | eq. 5 | coefficient of the fourth derivative in x
a_2         | kg*m     | r | a_2 | eq. 5 | coefficient of the mixed derivative
a_3         | kg/m     | + | a_3 | eq. 5 | coefficient of the second derivative in t
a_4         | kg*s^2/m | + | a_4 | eq. 5 | coefficient of the fourth derivative in t
M_1         | kg       | + | M_1 | eq. 7 | modal mass of a wavelength
A_zm        | N/m      | r | A_{zm} | eq. 7 | modal force per length
lambda      | m        | + | \lambda | eq. 7 | wavelength
t_1         | s        | r | t_1 | Sect. 3.2 | phase A is switched off
t_2         | s        | r | t_2 | Sect. 3.2 | A is switched on, B off
t_3         | s        | r | t_3 | Sect. 3.2 | B is switched on
t_4         | s        | r | t_4 | Sect. 3.2 | the cycle ends
omega_d     | rad/s    | + | \omega_d | ours | frequency of the damped free motion, omega_n sqrt(1 - xi^2)
A_Aredu     | m        | + | A_{Aredu} | ours | amplitude of A's free motion at t_1
varphi_Aredu | rad     | r | \varphi_{Aredu} | eq. 9 | phase of A's free motion at t_1
R_Aaddredu  | m        | + | R_{Aaddredu} | ours | amplitude of A's free motion at t_2
A_ABaddredu | m        | r | A_{ABaddredu} | eq. 9 | beating amplitude of phase A after t_2
Theta_Baddredu | rad   | r | \Theta_{Baddredu} | eq. 9 | phase of A's free motion at t_2
Psi_Aaddredu | rad     | r | \Psi_{Aaddredu} | eq. 9 | phase of A's forced motion at t_2
varphi_Baddredu | rad  | r | \varphi_{Baddredu} | eq. 9 | slow part of A's phase after t_2
A_Baddredu  | m        | + | A_{Baddredu} | ours | amplitude of B's free motion at t_2
R_Badd      | m        | + | R_{Badd} | ours | amplitude of B's free motion at t_3
A_Badd      | m        | r | A_{Badd} | eq. 10 | beating amplitude of phase B after t_3
Theta_Badd  | rad      | r | \Theta_{Badd} | eq. 10 | phase of B's free motion at t_3
Psi_Badd    | rad      | r | \Psi_{Badd} | eq. 10 | phase of B's forced motion at t_3, less pi
varphi_Badd | rad      | r | \varphi_{Badd} | eq. 10 | slow part of B's phase after t_3
zeta_z      | m        | r | \zeta_z | eq. 11 | vertical displacement of a surface point
zeta_x      | m        | r | \zeta_x | eq. 11 | tangential displacement of a surface point
A_Q         | m        | + | A_Q | eq. 12 | amplitude of the rotating vectors' sum
A_A         | m        | r | A_A | eq. 12 | amplitude of phase A at the point
A_B         | m        | r | A_B | eq. 12 | amplitude of phase B at the point
t_Q         | s        | r | t_Q | eq. 12 | start of the region
theta_Q     | rad      | r | \theta_Q | eq. 12 | phase difference of the vectors at t_Q
Delta_omega_redu | rad/s | r | \Delta\omega_{redu} | eq. 14 | rate of the phase difference in T_redu
Delta_omega_addredu | rad/s | r | \Delta\omega_{addredu} | eq. 14 | rate of the phase difference in T_addredu
Delta_omega_add | rad/s | r | \Delta\omega_{add} | eq. 14 | rate of the phase difference in T_add
T_redu      | s        | + | T_{redu} | eq. 15 | beat period in the first region
T_addredu   | s        | + | T_{addredu} | eq. 15 | beat period in the second region
T_add       | s        | + | T_{add} | eq. 15 | beat period in the third region
v_x         | m/s      | r | v_x | eq. 16 | tangential velocity of a surface point
A_v         | m/s      | + | A_v | eq. 17 | amplitude of the tangential velocity
Psi_v       | rad      | r | \Psi_v | eq. 17 | phase angle of the tangential velocity
M_a         | m/s      | r | M_a | eq. 18 | sine's part of the tangential velocity over D k_c
M_b         | m/s      | r | M_b | eq. 19 | cosine's part of the tangential velocity over D k_c
N_a         | 1/s      | r | N_a | eq. 18 | M_a between t_1 and t_2, where eq. 17 takes W_maxf out of it
N_b         | 1/s      | r | N_b | eq. 19 | M_b between t_1 and t_2
x_max       | m        | r | x_{max} | eq. 20 | position of the crest
zeta_zmax   | m        | + | \zeta_{zmax} | eq. 21 | displacement of the crest
v_xmax      | m/s      | r | v_{xmax} | eq. 22 | tangential velocity of the crest
A_ell       | m^2      | r | A_{ell} | eq. 23 | coefficient of zeta_x^2 in the conic
B_ell       | m^2      | r | B_{ell} | eq. 23 | coefficient of zeta_x zeta_z in the conic
C_ell       | m^2      | r | C_{ell} | eq. 23 | coefficient of zeta_z^2 in the conic
F_ell       | m^4      | r | F_{ell} | eq. 23 | right side of the conic
p_A         | 1        | r | P_{Aredu} | eq. 23 | modal response of phase A in T_redu, printed without W_maxf
p_B         | 1        | r | P_{Bredu} | eq. 23 | modal response of phase B in T_redu, printed without W_maxf
P_A         | m        | r | P_A | eq. 23 | modal response of phase A
P_B         | m        | r | P_B | eq. 23 | modal response of phase B
rho_k       | m        | + | \rho_k | eq. 25 | equivalent curvature diameter of the crest
C_E         | 1/Pa     | + | C_E | eq. 26 | contact compliance of stator and layer
x_xm        | m        | r | x_{xm} | eq. 27 | right end of the contact
x_vm        | m        | r | x_{vm} | eq. 28 | printed for x_xm; defined nowhere
delta_0     | m        | r | \delta_0 | eq. 28 | displacement at the ends of the contact
v_xm        | m/s      | r | v_{xm} | eq. 29 | tangential velocity at the end of the contact
phi_vm1     | m        | r | \varphi_{vm1} | eq. 33 | position of an extremum of the tangential velocity
phi_vm2     | m        | r | \varphi_{vm2} | eq. 35 | position of the other extremum
x_px        | m        | r | x_{px} | eq. 34 | position of a nonsliding point
v_xp        | m/s      | r | v_{xp} | Sect. 4.2 | tangential velocity of the nonsliding point, the rotor's surface speed
v_xx        | m/s      | r | v_{xx} | Sect. 4.2 | tangential velocity of a point of the stator's surface
f_t         | N        | r | f_t | Sect. 4.2 | friction of the driving zone
f_b         | N        | r | f_b | Sect. 4.2 | friction of the braking zone
f_nall      | N        | r | f_{nall} | eq. 38 | resultant of the friction
M_n         | N*m      | r | M_n | eq. 38 | driving torque
v_s         | rad/s    | r | v_s | eq. 39 | mean speed
I           | 1        | + | I | eq. 39 | number of samples
S_k         | rad/s    | r | S_k | eq. 40 | standard deviation of the speed
S_s         | rad/s    | r | S_s | eq. 41 | printed for S_k
Q_aver      | 1/s      | r | Q_{aver} | eq. 43 | speed determinant
X           | 1        | + | X | eq. A14 | forward over backward, of Q
Y           | 1        | + | Y | eq. A16 | the same of Q squared
W_a         | m        | + | W_a | eq. A1 | amplitude of phase A
W_b         | m        | + | W_b | eq. A1 | amplitude of phase B
omega_a     | rad/s    | + | \omega_a | eq. A1 | angular frequency of phase A
omega_b     | rad/s    | + | \omega_b | eq. A1 | angular frequency of phase B
varphi_a    | rad      | r | \varphi_a | eq. A1 | phase of phase A
varphi_b    | rad      | r | \varphi_b | eq. A1 | phase of phase B
Q_q         | m^2/s    | r | Q_q | eq. 24 | direction determinant
T_q         | s        | + | T_q | eq. A9 | period of the determinant
w_A         | m        | f t | w_A | eq. 9 | modal response of phase A
w_B         | m        | f t | w_B | eq. 10 | modal response of phase B
"""


def _symbol(name: str, positive: bool) -> sp.Symbol:
    return sp.Symbol(name, positive=True) if positive else sp.Symbol(name, real=True)


# Where the paper uses one letter, or nearly one, for several things: letter -> its meanings, with their places.
CLASHES: dict[str, tuple[str, ...]] = {
    r"\omega": ("displacement of the beam (eqs. 3, 4, 5)", "angular frequency (eq. 4 on), in the same equation (4)"),
    "m": ("drive pulses per cycle (Sect. 5.2.1)", "number of wave crests (k_dx, eqs. 25, 26, 36)"),
    r"\theta": ("rotation of the section (eq. 3)", "phase difference theta_Q (eqs. 12, 14), Theta_Q in the text"),
    "A": ("area of the section (eq. 2)", "phase A", "amplitude vectors A_A, A_B, A_Q (eqs. 12, 13)"),
    "A_p": ("area of the ceramic (eq. 2)", "coefficient of the pressure (eq. 30)"),
    "D": ("tooth surface to neutral axis (eq. 1)", "lever arm of the ceramic, as D/2 (eq. 7)"),
    "h_e": ("thickness of the beam with teeth (Sect. 2.1)", "thickness of the teeth (Table 1)", "k_e (Sect. 2.1)"),
    "R": ("radius (eq. 4)", "diameter (Table 1; lambda below eq. 7)"),
    "k_{dx}": ("stiffness of the layer, N/m (below eq. 5, eq. 6)", "printed k_ds in eq. 5, where N/m^2 is needed"),
    r"\kappa": ("shear correction coefficient (eq. 3, Table 1)", "height-width ratio of the section (Table 1)"),
    r"\xi": ("damping ratio (eq. 7)", "displacements xi_z, xi_x (eqs. A2 to A13), called zeta in eq. 11"),
    r"\zeta": ("displacements zeta_z, zeta_x (eq. 11)", "damping ratio in the first row of eq. 9 and in eq. 24"),
    r"\Delta\omega": ("drive less resonance (eq. 14)", "half of that in the second row of eq. 14", "Hz (Table 5)"),
    "Q": ("particle point (Sect. 3.1)", "direction determinant Q_q (eq. 24), also called Q_redu and Q_qredu"),
    "M": ("modal mass M_1 (eq. 7)", "M_a, M_b in eqs. 17 to 19", "torque M_n (eq. 38)"),
    "P": ("load P(x,t), written p in eq. 3", "P_A, P_B, modal responses (eqs. 23, A11)"),
    "p": ("load per length of the beam (eq. 3)", "pressure of the layer (eqs. 30 to 32, 36)"),
    "I": ("second moments I_z, I_e, I_p (eq. 2)", "number of samples (eqs. 39, 41)"),
    r"\mu": ("Poisson's ratios mu_e, mu_m (eq. 26, Table 1)", "friction coefficient (eq. 36)"),
    "v": ("tangential velocities, m/s (eqs. 16 to 38)", "speeds v_i, v_s of the motor, angle per time (eqs. 39 to 41)"),
    "S": ("standard deviation S_k (eq. 40)", "printed S_s in eq. 41"),
    "f": ("friction f_t, f_b, f_n, f_nall (eqs. 36, 38)", "factor f(Y) of Q_vib (eqs. A16, A17)"),
    "x": ("place along the circumference", "place of the contact's end, x_xm in eq. 27, x_vm in eq. 28"),
    "T": ("beat periods T_redu ... (eq. 15)", "regions T_reduT ... (Sect. 3.2)", "torque T_load (eq. 38)"),
}


def _table_row(line: str, table: dict[str, SymbolEntry]) -> tuple[str, SymbolEntry]:
    name, unit, kind, latex, where, meaning = (part.strip() for part in line.split("|"))
    if kind.startswith("f"):
        symbol = sp.Function(name)(*(table[argument].symbol for argument in kind.split()[1:]))
    else:
        symbol = _symbol(name, positive=kind == "+")
    return name, SymbolEntry(symbol, unit, meaning, latex, where)


def _entries() -> dict[str, SymbolEntry]:
    table: dict[str, SymbolEntry] = {}
    motor = load_motor("trum60")
    for field in fields(Motor):
        spec = field.metadata.get("spec")
        if spec is not None:
            symbol = _symbol(spec.symbol, positive=spec.domain.low >= 0)
            given = getattr(motor, field.name)
            where = "motor file" if given is None else given.source
            table[spec.symbol] = SymbolEntry(symbol, spec.unit, field.name.replace("_", " "), sp.latex(symbol), where)
    for line in (_REST + _PAPER).strip().splitlines():
        if not line:
            continue
        name, entry = _table_row(line, table)
        if name in table:
            raise ValueError(f"symbol {name} is defined twice")
        table[name] = entry
    return table


NOMENCLATURE = _entries()
_LATEX = {entry.symbol: entry.latex for entry in NOMENCLATURE.values() if isinstance(entry.symbol, sp.Symbol)}

# Keeps a quotient finite where both sides vanish; has whatever dimension it is added to.
TINY = sp.Symbol("tiny", positive=True)
# Symbols that are no arguments: their values in the kernels.
CONSTANTS = {NOMENCLATURE["N_1"].symbol: 1.0, NOMENCLATURE["g"].symbol: 9.80665, TINY: 1e-37}


def sym(names: str) -> tuple[sp.Symbol, ...]:
    """The symbols of the nomenclature by their names, separated by spaces; functions with their arguments, w_A(t)."""
    return tuple(NOMENCLATURE[name].symbol for name in names.split())


_INTERVAL = re.compile(r"\\text\{for\}\\: t \\geq (t_\d) \\wedge t \\leq (t_\d)")


def latex(expr: sp.Basic) -> str:
    """LaTeX with the nomenclature's names, intervals as the paper writes them."""
    text = str(sp.latex(expr, symbol_names=_LATEX, fold_short_frac=False, ln_notation=True))
    return _INTERVAL.sub(r"t \\in [\1, \2]", text)
