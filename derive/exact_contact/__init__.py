# SPDX-License-Identifier: BSD-3-Clause
"""Exact half-space theory of steady rolling, and the table of the creep law "exact".

``python -m derive.exact_contact`` computes the table that the package ships
(``railsym/data/contact/exact_table.npz``); nothing here is imported at run time.

Rolling of two equal elastic half-spaces (J.J. Kalker, Three-Dimensional Elastic Bodies
in Rolling Contact, Kluwer 1990) on a Hertzian ellipse in lengths sqrt(a b) and forces mu N,
shear modulus 1: the dimensionless creepages are

    e1 = G a b xi/(mu N)    e2 = G a b eta/(mu N)    e3 = G (a b)^(3/2) phi/(mu N)
"""
