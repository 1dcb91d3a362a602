"""Pictures of Wilkie et al. 2021, from the model and from the tracer that it was fitted to."""
