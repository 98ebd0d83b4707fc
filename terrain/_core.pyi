# Types of the compiled core; what it does is said in terrain/_kernel.py.
