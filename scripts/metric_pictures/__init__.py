"""Pictures of metrics: what each measures, drawn from one run."""
