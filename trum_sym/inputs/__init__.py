"""What a user gives: motors, drives, measured data, units; every value is checked where it enters."""
