//! Motion by the laws: forces, Lagrange multipliers, integration, impacts, friction.
