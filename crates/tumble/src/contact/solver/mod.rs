//! The implicit solution of the contact law: impulses of all contacts at once, for any step.
//!
//! The kick of a step is an impulse p ≥ 0 of each contact that satisfies the law of the scene at the end of the step, not at its
//! middle ([`law`]). Contacts of one body depend on each other, so their impulses are found by iterations: one contact after the
//! other takes the impulse that its law asks for at the velocities that all impulses so far lead to (projected Gauss–Seidel;
//! M. Servin et al., Int. J. Numer. Meth. Engng 97 (2014) 878). Each impulse acts on both bodies of a contact, so momentum is
//! conserved however many iterations run.
//!
//! | step | file | from | to |
//! |---|---|---|---|
//! | bodies | `bodies` | states | velocities, inverse masses |
//! | groups | `groups` | contacts within reach | the contacts of two bodies, or of a body and a wall, as a group |
//! | colours | `colouring` | groups | groups that share no body, to be solved side by side |
//! | rows | `rows` | groups of one colour | packs of eight groups, one per lane; a row is a contact of each |
//! | law | `law` | gaps, velocities, stretches | coefficients of the rows |
//! | iterations | `iterations` | coefficients | impulses |
//! | losses | `losses` | impulses | energy that contacts take |
//! | results | `results` | impulses | states of bodies, friction springs |
//!
//! Groups, colours and packs depend on the contacts alone, not on neighbour lists or threads. So a run that resumes continues with the
//! same bits.

mod bodies;
mod colouring;
mod groups;
mod iterations;
mod joints;
mod law;
mod losses;
mod normal_impulse;
mod results;
mod rows;

pub(crate) use self::iterations::Outcome;
pub(super) use self::results::Found;
pub(crate) use self::results::Solver;
